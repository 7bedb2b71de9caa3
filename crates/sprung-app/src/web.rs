//! The door to a page: the same window in a canvas.

use std::panic;
use std::sync::mpsc::{Receiver, channel};

use eframe::{WebOptions, WebRunner, web_sys};
use js_sys::Uint8Array;
use sprung::{Code, Error, Result};
use sprung_driver::{Handle, Options, Post, Word};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};

use crate::app::App;
use crate::beginning::first;
use crate::link::{self, Link};
use crate::page;
use crate::settings::Settings;

/// The canvas of the page.
const CANVAS: &str = "sprung";

/// Memory for the recorded run, bytes: a page has at most 4 GiB, and phones give it less.
const HISTORY_BYTES: usize = 128 << 20;

/// A scene that needs more is refused, bytes.
const MEMORY_LIMIT: u64 = 1 << 30;

/// Begins; it goes on by itself as the browser asks for pictures.
pub fn start() {
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        usual(info);
        page::failed(&info.to_string());
    }));
    wasm_bindgen_futures::spawn_local(async {
        if let Err(reason) = run().await {
            page::failed(&reason);
        }
    });
}

async fn run() -> Result<(), String> {
    let document = web_sys::window().and_then(|window| window.document()).ok_or("there is no page")?;
    let canvas = document.get_element_by_id(CANVAS).and_then(|it| it.dyn_into().ok());
    let canvas: web_sys::HtmlCanvasElement = canvas.ok_or("the page has no canvas")?;
    let create = |context: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
        Ok(Box::new(create(context)?))
    };
    let started = WebRunner::new().start(canvas, WebOptions::default(), Box::new(create)).await;
    started.map_err(|reason| why(&reason))?;
    page::ready();
    Ok(())
}

fn create(context: &eframe::CreationContext<'_>) -> Result<App> {
    if context.wgpu_render_state.is_none() {
        return Err(Error::new(Code::NoWindow, "the browser gives neither WebGPU nor WebGL 2 to draw with"));
    }
    let options =
        Options { history_bytes: HISTORY_BYTES, memory_limit: Some(MEMORY_LIMIT), ..Default::default() };
    let (linked, bad_link) = match link::read(&page::fragment()) {
        Ok(linked) => (linked, None),
        Err(error) => (None, Some(error)),
    };
    let settings = Settings::load(context.storage);
    let (beginning, origin, refused, view) = match linked {
        Some(Link { source, origin, view, other_version }) => {
            (source.into(), origin, other_version.as_deref().map(from_another), view)
        }
        None => {
            let (beginning, origin, refused) = first(None, None, &settings, &options)?;
            (beginning, origin, refused, None)
        }
    };
    let (post, words) = worker(&context.egui_ctx);
    let mut app = App::new(Handle::remote(beginning, options, post, words)?, context);
    if let Some(view) = view {
        app.look_from(view);
    }
    app.state_mut().files.origin = origin;
    bad_link.into_iter().chain(refused).for_each(|error| app.state_mut().refuse(error));
    Ok(app)
}

/// A worker to simulate in: where messages go, and where they come from.
fn worker(context: &egui::Context) -> (Post, Receiver<Word>) {
    let (heard, words) = channel();
    let context = context.clone();
    let take = move |message: Option<Uint8Array>, reason: Option<String>| {
        let word = match message {
            Some(message) => Word::Message(message.to_vec()),
            None => Word::Ended(reason.unwrap_or_default()),
        };
        // The page may be going: then nobody hears it.
        let _ = heard.send(word);
        context.request_repaint();
    };
    let take = Closure::<dyn Fn(Option<Uint8Array>, Option<String>)>::new(take);
    let tell = page::work(&take.into_js_value());
    let post = move |message: Vec<u8>| {
        // What a worker that is gone does not hear, it has said before.
        let _ = tell.call1(&JsValue::NULL, &Uint8Array::from(&message[..]));
    };
    (Box::new(post), words)
}

/// The word on a link that another version made.
fn from_another(version: &str) -> Error {
    let sentence = format!(
        "was made by version {version} of sprung, and this is {}: the motion may differ in its last digits",
        link::VERSION
    );
    Error::new(Code::Conflict, sentence).in_file("the link")
}

/// What a browser gives as a reason.
fn why(reason: &JsValue) -> String {
    let message = reason.dyn_ref::<js_sys::Error>().map(|error| String::from(error.message()));
    message.or_else(|| reason.as_string()).unwrap_or_else(|| format!("{reason:?}"))
}
