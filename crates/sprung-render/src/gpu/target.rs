//! What is drawn into: colour and depth of all samples, the picture they become, and the one that egui shows.

use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindingResource, Device, Extent3d,
    Texture, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView,
};

use super::pipelines::{DEPTH, FINISHED};
use super::quality::Quality;

/// All textures of one picture's size.
pub struct Target {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// All samples of linear light; none if there is one for each pixel.
    pub samples: Option<TextureView>,
    /// Their depths.
    pub depth: TextureView,
    /// Their mean.
    pub resolved: TextureView,
    /// The same in sRGB numbers.
    pub finished: Texture,
    /// A view of it.
    pub finished_view: TextureView,
    /// The mean, as the last pass reads it.
    pub drawn: BindGroup,
}

impl Target {
    /// Makes them.
    pub fn new(device: &Device, drawn: &BindGroupLayout, size: [u32; 2], quality: Quality) -> Self {
        let (colour, samples) = (quality.colour(), quality.samples());
        let both = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let only = TextureUsages::RENDER_ATTACHMENT;
        let view = |label, format, samples, usage| {
            make(device, label, size, format, samples, usage).create_view(&Default::default())
        };
        let resolved = view("resolved", colour, 1, both);
        let finished = make(device, "finished", size, FINISHED, 1, both | TextureUsages::COPY_SRC);
        let drawn = device.create_bind_group(&BindGroupDescriptor {
            label: Some("drawn"),
            layout: drawn,
            entries: &[BindGroupEntry { binding: 0, resource: BindingResource::TextureView(&resolved) }],
        });
        Self {
            size,
            samples: (samples > 1).then(|| view("samples", colour, samples, only)),
            depth: view("depth", DEPTH, samples, only),
            resolved,
            finished_view: finished.create_view(&Default::default()),
            finished,
            drawn,
        }
    }
}

/// The size that a device can draw: at least a pixel, at most its limit.
pub fn possible(device: &Device, size: [u32; 2]) -> [u32; 2] {
    size.map(|side| side.clamp(1, device.limits().max_texture_dimension_2d))
}

/// A texture to draw into.
pub fn make(
    device: &Device,
    label: &str,
    [width, height]: [u32; 2],
    format: TextureFormat,
    sample_count: u32,
    usage: TextureUsages,
) -> Texture {
    device.create_texture(&TextureDescriptor {
        label: Some(label),
        size: Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}
