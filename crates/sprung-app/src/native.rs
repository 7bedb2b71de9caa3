//! The door to a window of the operating system.

use sprung::scene::Scene;
use sprung::{Code, Error, Result};
use sprung_driver::{Driver, Handle, Source};

use crate::app::App;

/// What the window begins with.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The scene; the last one if none is given, and the jelly at the very first start.
    pub source: Option<Source>,
}

/// Opens the window and returns when it is closed.
///
/// # Errors
/// [`Code::Unsupported`] if there is no display or no graphics driver.
pub fn run(options: Options) -> Result<()> {
    let source = match options.source {
        Some(source) => source,
        None => Source { name: "jelly".to_owned(), scene: Scene::builtin("jelly")? },
    };
    let driver = Handle::inline(Driver::new(source)?);
    let native = eframe::NativeOptions { renderer: eframe::Renderer::Wgpu, ..Default::default() };
    eframe::run_native("sprung", native, Box::new(|context| Ok(Box::new(App::new(driver, context)))))
        .map_err(|error| Error::new(Code::Unsupported, format!("cannot open a window: {error}")))
}
