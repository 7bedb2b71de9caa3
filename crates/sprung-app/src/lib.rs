//! The sprung window: watch, grab and understand mass-spring systems.
//!
//! The app never touches a simulation. It sends commands to a driver and draws the newest report. Nothing here waits,
//! starts a thread or opens a file, but for two doors: [`files`], and [`run`], which opens a window of the operating system
//! and puts the driver on a thread of its own.

mod action;
mod app;
mod beginning;
mod card;
pub mod explain;
pub mod files;
mod icon;
pub mod link;
mod media;
mod motion;
#[cfg(not(target_arch = "wasm32"))]
mod native;
#[cfg(target_arch = "wasm32")]
mod page;
mod panel;
pub mod plots;
mod settings;
mod state;
mod text;
mod theme;
mod timeline;
mod view;
#[cfg(target_arch = "wasm32")]
pub mod web;

pub use action::{ACTIONS, Action, ActionInfo};
pub use app::App;
pub use card::GESTURES;
pub use media::{Film, FilmClock, Filming, PictureSize, SaveRequest};
#[cfg(not(target_arch = "wasm32"))]
pub use native::{Options, run};
pub use panel::PLANETS;
pub use sprung_driver::{Beginning, Running, Source};
pub use state::{AppState, Overlays, Pick, Shown, Tool};
