//! A graphics device without a window: for tests and saved pictures.

use std::future::Future;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

use sprung::{Code, Error, Result};

/// A device, its queue, and what it calls itself.
pub struct Headless {
    /// The driver's name, kind and version.
    pub info: wgpu::AdapterInfo,
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
}

/// Opens a graphics device without a window, natively.
///
/// # Errors
/// [`Code::Unsupported`] if there is no driver, or if it will not open a device.
pub fn headless() -> Result<Headless> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = wait(instance.request_adapter(&wgpu::RequestAdapterOptions::default()));
    let adapter = adapter.map_err(|error| missing(&error.to_string()))?;
    let wanted = wgpu::DeviceDescriptor {
        label: Some("sprung"),
        required_limits: wgpu::Limits::downlevel_webgl2_defaults().using_resolution(adapter.limits()),
        ..Default::default()
    };
    let (device, queue) =
        wait(adapter.request_device(&wanted)).map_err(|error| missing(&error.to_string()))?;
    Ok(Headless { info: adapter.get_info(), device, queue })
}

fn missing(reason: &str) -> Error {
    let reason = reason.lines().next().unwrap_or_default();
    Error::new(Code::Unsupported, format!("there is no graphics driver that can draw: {reason}"))
        .with_fix("install a Vulkan or OpenGL driver; Mesa's lavapipe needs no graphics card")
}

/// Waits for a future. Natively these are ready at once.
fn wait<F: Future>(future: F) -> F::Output {
    let mut future = pin!(future);
    loop {
        if let Poll::Ready(output) = future.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            return output;
        }
        std::thread::yield_now();
    }
}
