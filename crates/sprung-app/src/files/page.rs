//! Files of a page: what the person chooses or drops is read into memory under its name, and what is saved is handed out as a
//! download.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use sprung_io::files::memory;
use sprung_io::import::READERS;
use wasm_bindgen::JsCast;
use wasm_bindgen::closure::Closure;
use wasm_bindgen_futures::spawn_local;

use super::{Found, OPENED, Origin, Refused, Wanted, find};
use crate::page;

/// Where the name of what is to be opened is put when all bytes are there.
type Arrival = Rc<RefCell<Option<PathBuf>>>;

thread_local! {
    /// Of what was dropped onto the page.
    static DROPPED: Arrival = Arrival::default();
}

/// The choice of a file. It never holds the page up: ask it each frame.
pub struct Dialog(Arrival);

impl Dialog {
    /// Asks for files to open; what is to be saved keeps its name, as the browser knows where downloads go.
    pub fn open(wanted: &Wanted<'_>) -> Self {
        let arrival = Arrival::default();
        if let Some(name) = wanted.save_as {
            arrival.replace(Some(PathBuf::from(name)));
            return Self(arrival);
        }
        let arrived = arrival.clone();
        let take = Closure::once_into_js(move |names: js_sys::Array, contents: js_sys::Array| {
            let files = names.iter().zip(contents.iter()).filter_map(|(name, content)| {
                Some((name.as_string()?, content.dyn_into::<js_sys::Uint8Array>().ok()?.to_vec()))
            });
            arrived.replace(arrive(files.collect()));
        });
        // Meshes lie beside scenes.
        let of_meshes = READERS.iter().flat_map(|reader| reader.endings.iter());
        let accepted = wanted.endings.iter().chain(of_meshes).map(|ending| format!(".{ending}"));
        page::pick(&accepted.collect::<Vec<_>>().join(","), &take);
        Self(arrival)
    }

    /// What has been chosen: `None` as long as nothing has. A browser does not say that nothing will be.
    pub fn poll(&mut self, context: &egui::Context) -> Option<Option<PathBuf>> {
        let chosen = self.0.take();
        if chosen.is_none() {
            context.request_repaint_after(web_time::Duration::from_millis(100));
        }
        chosen.map(Some)
    }
}

/// Puts files where they can be read, in place of those before; gives the one to be opened.
fn arrive(files: Vec<(String, Vec<u8>)>) -> Option<PathBuf> {
    memory::clear();
    let is_opened =
        |name: &str| Path::new(name).extension().is_some_and(|it| OPENED.iter().any(|ending| it == *ending));
    let main = files.iter().find(|(name, _)| is_opened(name)).or(files.first());
    let main = main.map(|(name, _)| PathBuf::from(name));
    files.into_iter().for_each(|(name, bytes)| memory::put(Path::new(&name), bytes));
    main
}

/// The scene or checkpoint among the files that were dropped onto the page, once they are read; its meshes may be among them.
pub fn dropped(context: &egui::Context) -> Option<Result<(Found, Origin), Refused>> {
    let files = context.input(|input| input.raw.dropped_files.clone());
    if !files.is_empty() {
        let context = context.clone();
        spawn_local(async move {
            let mut read = Vec::new();
            for file in files {
                // What cannot be read is missed where it is needed, and that is said there.
                if let Ok(bytes) = file.bytes_async().await {
                    read.push((file.path().display().to_string(), bytes));
                }
            }
            DROPPED.with(|arrival| arrival.replace(arrive(read)));
            context.request_repaint();
        });
    }
    let path = DROPPED.with(|arrival| arrival.take())?;
    Some(find(&path).map(|found| (found, Origin::Other(path.display().to_string()))))
}

/// Hands out what was saved since this was called last.
pub fn hand_out() {
    for (path, bytes) in memory::take_written() {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        page::download(&name, &bytes);
    }
}
