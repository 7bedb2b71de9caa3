//! How much work a picture may be: a graphics card does it in its sleep, a processor that plays one does not.

use wgpu::{AdapterInfo, DeviceType, TextureFormat};

/// How much work goes into each pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// For graphics cards: four samples for each pixel, and soft shadows.
    #[default]
    Full,
    /// For drivers that draw on the processor: one sample and edges smoothed afterwards, simpler light on springs, a
    /// smaller shadow map, and fewer triangles where there are as many as pixels.
    Software,
}

impl Quality {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Full, Self::Software];

    /// What suits an adapter: [`Quality::Software`] if it says that it is a processor, as Mesa's lavapipe and
    /// SwiftShader do.
    pub fn for_adapter(info: &AdapterInfo) -> Self {
        if info.device_type == DeviceType::Cpu { Self::Software } else { Self::Full }
    }

    /// Samples of a pixel; every device can do four.
    pub(super) fn samples(self) -> u32 {
        match self {
            Self::Full => 4,
            Self::Software => 1,
        }
    }

    /// What the scene is drawn into: linear light kept in sRGB bytes, or the sRGB numbers themselves, which a processor
    /// reads and writes faster.
    pub(super) fn colour(self) -> TextureFormat {
        match self {
            Self::Full => TextureFormat::Rgba8UnormSrgb,
            Self::Software => TextureFormat::Rgba8Unorm,
        }
    }

    /// Texels along each side of the shadow map.
    pub(super) fn shadow_side(self) -> u32 {
        match self {
            Self::Full => 1024,
            Self::Software => 512,
        }
    }

    /// Whether surfaces are drawn with fewer triangles where there are many.
    pub(super) fn is_coarse(self) -> bool {
        self == Self::Software
    }

    /// The constant `quick` of common.wgsl.
    pub(super) fn constants(self) -> [(&'static str, f64); 1] {
        [("quick", if self == Self::Software { 1.0 } else { 0.0 })]
    }
}
