//! The door to a window of the operating system.

use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetupCreateNew, wgpu};
use egui::{IconData, ViewportBuilder};
use sprung::{Code, Error, Inline, Result, Workers};
use sprung_driver::{Beginning, Driver, Handle};

use crate::app::App;
use crate::beginning::first;
use crate::settings::{Settings, ZOOM};

/// What the system knows the window by: for its settings, its icon and its taskbar.
const APP_ID: &str = "sprung";

/// The window's size when it opens first, points.
const SIZE: [f32; 2] = [1280.0, 820.0];

/// The least it can be made, points.
const LEAST_SIZE: [f32; 2] = [480.0, 360.0];

/// What the window begins with.
#[derive(Clone)]
pub struct Options {
    /// The scene or a simulation that is under way; the last one if none is given, and the jelly at the very first start.
    pub beginning: Option<Beginning>,
    /// The file that this was read from, if it was: the next start finds it there, and saving suggests it.
    pub path: Option<PathBuf>,
    /// Scenes and checkpoints that need more memory than this are refused, bytes. `None`: no limit.
    pub memory_limit: Option<u64>,
    /// Threads for the steps, besides the one that takes them.
    pub workers: Arc<dyn Workers>,
}

impl Default for Options {
    fn default() -> Self {
        Self { beginning: None, path: None, memory_limit: None, workers: Arc::new(Inline) }
    }
}

/// Opens the window and returns when it is closed.
///
/// # Errors
/// [`Code::NoWindow`] if there is no display or no graphics driver, [`Code::Unsupported`] if the window fails in another way; what building the scene says, if it cannot be.
pub fn run(options: Options) -> Result<()> {
    let viewport = ViewportBuilder::default()
        .with_app_id(APP_ID)
        .with_title("sprung")
        .with_icon(Arc::new(icon(64)))
        .with_inner_size(SIZE)
        .with_min_inner_size(LEAST_SIZE);
    let native = eframe::NativeOptions {
        viewport,
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: graphics(),
        ..Default::default()
    };
    let create = move |context: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
        Ok(Box::new(create(options, context)?))
    };
    eframe::run_native_ext(APP_ID, native, fresh_context(), Box::new(create)).map_err(explain)
}

/// An empty egui context where the stored one would be of no use; else `None`, and the stored one is taken.
///
/// egui keeps its own zoom beside ours, and the window is made before anything of ours is asked: with a zoom of 1e9 it
/// would need more pixels than there is memory for.
fn fresh_context() -> Option<egui::Context> {
    let stored = eframe::storage_dir(APP_ID)?.join("app.ron");
    // What egui stores has a few KiB; of a file that is much longer nothing is believed.
    let text = sprung_io::files::read_ordinary(&stored, 16 << 20).map(|bytes| String::from_utf8(bytes).ok());
    match text {
        Ok(Some(text)) if zooms_are_sane(&text) => None,
        // There is none yet.
        Err(_) if !stored.exists() => None,
        _ => Some(egui::Context::default()),
    }
}

/// Whether every zoom in the stored text is one that a window can have.
fn zooms_are_sane(text: &str) -> bool {
    text.split("zoom_factor:").skip(1).all(|rest| {
        let end = rest.find([',', ')']).unwrap_or(rest.len());
        rest[..end].trim().parse::<f32>().is_ok_and(|zoom| ZOOM.contains(&zoom))
    })
}

/// As egui would have it, but for the choice of the adapter and the size of pictures: a window across several screens is
/// wider than the 8192 pixels that egui asks for.
fn graphics() -> WgpuConfiguration {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.native_adapter_selector = Some(Arc::new(|adapters, surface| {
        let can_show =
            |adapter: &&wgpu::Adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface));
        let best = adapters.iter().filter(can_show).min_by_key(|adapter| rank(&adapter.get_info()));
        best.cloned().ok_or_else(|| "No suitable graphics adapter found".to_owned())
    }));
    let usual = setup.device_descriptor.clone();
    setup.device_descriptor = Arc::new(move |adapter| {
        let mut descriptor = usual(adapter);
        descriptor.required_limits.max_texture_dimension_2d = adapter.limits().max_texture_dimension_2d;
        descriptor
    });
    WgpuConfiguration { wgpu_setup: setup.into(), ..Default::default() }
}

/// The lower, the better. Of two drivers that draw on the processor OpenGL's is taken: Mesa's Vulkan one, lavapipe, takes a
/// few megabytes more with every picture that it shows in a window (seen with version 22.3).
fn rank(adapter: &wgpu::AdapterInfo) -> u32 {
    match (adapter.device_type, adapter.backend) {
        (wgpu::DeviceType::DiscreteGpu, wgpu::Backend::Gl) => 1,
        (wgpu::DeviceType::DiscreteGpu, _) => 0,
        (wgpu::DeviceType::IntegratedGpu, wgpu::Backend::Gl) => 3,
        (wgpu::DeviceType::IntegratedGpu, _) => 2,
        // OpenGL does not say of every graphics card what it is.
        (wgpu::DeviceType::VirtualGpu | wgpu::DeviceType::Other, _) => 4,
        (wgpu::DeviceType::Cpu, wgpu::Backend::Gl) => 5,
        (wgpu::DeviceType::Cpu, _) => 6,
    }
}

fn create(options: Options, context: &eframe::CreationContext<'_>) -> Result<App> {
    let settings = Settings::load(context.storage);
    let Options { beginning, path, memory_limit, workers } = options;
    let limits = sprung_driver::Options { memory_limit, workers, ..Default::default() };
    let is_known = beginning.is_none();
    let (beginning, origin, refused) = first(beginning, path.as_deref(), &settings, &limits)?;
    let repaint = context.egui_ctx.clone();
    let driver = Driver::with(beginning, limits)?;
    let driver = Handle::thread(driver, Box::new(move || repaint.request_repaint()))?;
    let mut app = App::new(driver, context);
    app.state_mut().files.origin = origin;
    if is_known {
        // It was said when this scene was opened.
        app.state_mut().warnings.clear();
    }
    if let Some(error) = refused {
        app.state_mut().refuse(error);
    }
    Ok(app)
}

/// One line that says what is missing and what to do.
fn explain(error: eframe::Error) -> Error {
    if let eframe::Error::AppCreation(inner) = error {
        return match inner.downcast::<Error>() {
            Ok(error) => *error,
            Err(inner) => unsupported(&inner.to_string()),
        };
    }
    unsupported(&error.to_string())
}

fn unsupported(reason: &str) -> Error {
    let has = |words: &[&str]| words.iter().any(|word| reason.contains(word));
    if has(&["WAYLAND_DISPLAY", "DISPLAY", "XOpenDisplay", "open connection to X"]) {
        return Error::new(Code::NoWindow, "there is no display to open a window on")
            .with_fix("start it in a desktop session, or use `sprung run`, which needs none");
    }
    if has(&["libX", "libxkb", "libwayland", "libxcb", ".so"]) {
        return Error::new(Code::NoWindow, format!("a library for windows is missing: {}", one_line(reason)))
            .with_fix("install libx11-6, libxcursor1, libxi6, libxkbcommon-x11-0 and libwayland-client0");
    }
    if has(&["adapter", "Adapter", "surface", "Surface", "device", "Device", "backend"]) {
        return Error::new(Code::NoWindow, "there is no graphics driver that can draw the window").with_fix(
            "install mesa-vulkan-drivers or the driver of your graphics card, or use `sprung run`",
        );
    }
    Error::new(Code::Unsupported, format!("cannot open a window: {}", one_line(reason)))
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A mass on a coil, drawn here so that no binary file has to be kept.
fn icon(size: u32) -> IconData {
    let mut rgba = Vec::with_capacity(4 * (size * size) as usize);
    for y in 0..size {
        for x in 0..size {
            // From −1 to 1, y upwards.
            let to = |pixel: u32| 2.0 * (pixel as f32 + 0.5) / size as f32 - 1.0;
            rgba.extend(icon_pixel(to(x), -to(y)));
        }
    }
    IconData { rgba, width: size, height: size }
}

fn icon_pixel(x: f32, y: f32) -> [u8; 4] {
    let ball = (x * x + (y + 0.5) * (y + 0.5)).sqrt();
    if ball < 0.4 {
        // Lit from the upper left.
        let light = 1.0 - 0.8 * ((x + 0.15).powi(2) + (y + 0.35).powi(2)).sqrt();
        return [(230.0 * light) as u8, (90.0 * light) as u8, (60.0 * light) as u8, 255];
    }
    // Four windings between the ceiling and the ball.
    let winding = 0.32 * (y * 22.0).sin();
    if (-0.15..0.85).contains(&y) && (x - winding).abs() < 0.16 {
        return [70, 110, 170, 255];
    }
    if (0.85..1.0).contains(&y) && x.abs() < 0.7 { [90, 95, 105, 255] } else { [0, 0, 0, 0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_said_in_one_line() {
        for (reason, words) in [
            (
                "winit EventLoopError: os error at x.rs:1: neither WAYLAND_DISPLAY nor WAYLAND_SOCKET nor DISPLAY is set.",
                "no display",
            ),
            ("WGPU error: Failed to create wgpu adapter, no suitable adapter found.", "no graphics driver"),
            ("WGPU error: No suitable graphics adapter found;\n\nvulkan not found", "no graphics driver"),
            ("WGPU error: There was no valid format for the surface at all.", "no graphics driver"),
            ("winit error: libxkbcommon-x11.so could not be loaded", "a library for windows is missing"),
            ("os error: Failed to open connection to X server", "no display"),
            ("something\nelse", "cannot open a window: something else"),
        ] {
            let error = unsupported(reason);
            let text = error.to_string();
            let can_be_none = words != "cannot open a window: something else";
            assert_eq!(error.code(), if can_be_none { Code::NoWindow } else { Code::Unsupported });
            assert!(text.contains(words) && !text.contains('\n'), "{text}");
        }
    }

    #[test]
    fn a_stored_zoom_that_no_window_can_have_is_noticed() {
        for (text, is_sane) in [
            ("", true),
            ("(options:(zoom_factor:1.0,zoom_with_keyboard:true))", true),
            ("(options:(zoom_factor:1.5))", true),
            ("(options:(zoom_factor:1e9,zoom_with_keyboard:true))", false),
            ("(options:(zoom_factor: 0.0,))", false),
            ("(options:(zoom_factor:NaN))", false),
            ("zoom_factor:1.0, zoom_factor:-1", false),
            ("zoom_factor:", false),
        ] {
            assert_eq!(zooms_are_sane(text), is_sane, "{text}");
        }
    }

    #[test]
    fn an_error_of_ours_comes_through_as_it_is() {
        let ours = Error::new(Code::TooLarge, "is too large");
        assert_eq!(explain(eframe::Error::AppCreation(Box::new(ours.clone()))), ours);
    }

    #[test]
    fn the_icon_is_a_picture() {
        let icon = icon(64);
        assert_eq!(icon.rgba.len(), 64 * 64 * 4);
        let opaque = icon.rgba.chunks(4).filter(|pixel| pixel[3] == 255).count();
        assert!((400..3500).contains(&opaque), "{opaque}");
    }
}
