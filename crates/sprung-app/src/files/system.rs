//! Files of a system: its dialogs, and what is dropped onto the window.

use std::future::Future;
use std::path::PathBuf;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, Wake, Waker};

use sprung::{Code, Error};
use sprung_driver::{Kept, Source};
use sprung_io::checkpoint;

use super::{Found, Origin, Refused, Wanted, find, parse_scene};

/// A dialog of the system that is open. It never holds the window up: ask it each frame.
///
/// Where the system has none, it says at once that nothing was chosen; so paths can always be typed as well.
pub struct Dialog(Pin<Box<dyn Future<Output = Option<PathBuf>>>>);

impl Dialog {
    /// Opens one.
    pub fn open(wanted: &Wanted<'_>) -> Self {
        let dialog =
            rfd::AsyncFileDialog::new().set_title(wanted.title).add_filter(wanted.kind, wanted.endings);
        let Some(name) = wanted.save_as else {
            let picked = dialog.pick_file();
            return Self(Box::pin(async { picked.await.map(|file| file.path().to_owned()) }));
        };
        let picked = dialog.set_file_name(name).save_file();
        Self(Box::pin(async { picked.await.map(|file| file.path().to_owned()) }))
    }

    /// What has been chosen: `None` as long as it is open, `Some(None)` if it was closed without.
    pub fn poll(&mut self, context: &egui::Context) -> Option<Option<PathBuf>> {
        let waker = Waker::from(Arc::new(Repaint(context.clone())));
        match self.0.as_mut().poll(&mut Context::from_waker(&waker)) {
            Poll::Ready(chosen) => Some(chosen),
            Poll::Pending => None,
        }
    }
}

/// Wakes the window when the dialog has something to say.
struct Repaint(egui::Context);

impl Wake for Repaint {
    fn wake(self: Arc<Self>) {
        self.0.request_repaint();
    }
}

/// The scene or checkpoint in the first of the files that were dropped onto the window, if any were.
pub fn dropped(context: &egui::Context) -> Option<Result<(Found, Origin), Refused>> {
    let file = context.input(|input| input.raw.dropped_files.first().cloned())?;
    let path = file.path().to_owned();
    let name = path.display().to_string();
    // On the desktop a dropped file has a path, and so a limit to what is read of it; else it comes as bytes.
    if path.is_absolute() {
        return Some(find(&path).map(|found| (found, Origin::File(path))));
    }
    let found = match file.bytes() {
        Ok(bytes) if checkpoint::is_name(&path) => {
            Ok(Found::Checkpoint(Kept::in_bytes(name.clone(), &bytes[..])))
        }
        Ok(bytes) => parse_scene(&bytes, &name).map(Found::Scene),
        Err(reason) => {
            let error = Error::new(Code::Unreadable, format!("cannot be read: {reason}"));
            Err(Refused { error: error.in_file(name), text: None })
        }
    };
    Some(found.map(|found| {
        let (Found::Scene(Source { name, .. }) | Found::Checkpoint(Kept { name, .. })) = &found;
        let origin = Origin::Other(name.clone());
        (found, origin)
    }))
}
