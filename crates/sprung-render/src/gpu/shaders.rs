//! The shaders: one file for each thing that is drawn, with the files that they share put in front.

/// A shader's name and its whole text.
pub struct Shader {
    /// Its name, for messages.
    pub name: &'static str,
    /// WGSL.
    pub text: &'static str,
}

macro_rules! shader {
    ($name:literal $(, $shared:literal)*) => {
        Shader {
            name: $name,
            text: concat!($(include_str!(concat!("shaders/", $shared, ".wgsl")), "\n",)* include_str!(concat!("shaders/", $name, ".wgsl"))),
        }
    };
}

/// Points.
pub const POINTS: Shader = shader!("points", "common", "shadow");
/// Springs and other straight pieces.
pub const LINES: Shader = shader!("lines", "common", "shadow");
/// Springs as coils.
pub const COILS: Shader = shader!("coils", "common", "shadow");
/// Cloths and skins.
pub const SURFACE: Shader = shader!("surface", "common", "shadow");
/// Planes.
pub const GROUND: Shader = shader!("ground", "common", "shadow");
/// What is behind everything.
pub const BACKDROP: Shader = shader!("backdrop", "common");
/// Velocities and forces.
pub const ARROWS: Shader = shader!("arrows", "common");
/// Rings around points.
pub const RINGS: Shader = shader!("rings", "common");
/// From linear light to sRGB numbers.
pub const FINISH: Shader = shader!("finish");

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::Quality;
    use wgpu::naga::back::glsl;
    use wgpu::naga::back::pipeline_constants::process_overrides;
    use wgpu::naga::front::wgsl;
    use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};

    const ALL: [Shader; 9] = [POINTS, LINES, COILS, SURFACE, GROUND, BACKDROP, ARROWS, RINGS, FINISH];

    #[test]
    fn every_shader_is_valid_without_a_driver() {
        for shader in ALL {
            let module = wgsl::parse_str(shader.text)
                .unwrap_or_else(|error| panic!("{}: {}", shader.name, error.emit_to_string(shader.text)));
            let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
            if let Err(error) = validator.validate(&module) {
                panic!("{}: {}", shader.name, error.emit_to_string(shader.text));
            }
            assert!(!module.entry_points.is_empty(), "{} draws nothing", shader.name);
        }
    }

    #[test]
    fn every_shader_can_be_told_to_webgl() {
        for shader in ALL {
            let module = wgsl::parse_str(shader.text).expect("the other test says what is wrong");
            let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
            let info = validator.validate(&module).expect("the other test says what is wrong");
            let options = glsl::Options {
                version: glsl::Version::Embedded { version: 300, is_webgl: true },
                ..Default::default()
            };
            for entry in &module.entry_points {
                let pipeline = glsl::PipelineOptions {
                    shader_stage: entry.stage,
                    entry_point: entry.name.clone(),
                    multiview: None,
                };
                // As wgpu does it: constants are put in first.
                for quality in Quality::ALL {
                    let constants = quality.constants().map(|(name, value)| (name.to_owned(), value));
                    let constants = constants.into_iter().collect();
                    let (module, info) = process_overrides(&module, &info, None, &constants)
                        .unwrap_or_else(|error| panic!("{}: {error}", shader.name));
                    let mut text = String::new();
                    let policies = wgpu::naga::proc::BoundsCheckPolicies::default();
                    let writer = glsl::Writer::new(&mut text, &module, &info, &options, &pipeline, policies);
                    let written = writer.and_then(|mut writer| writer.write());
                    assert!(written.is_ok(), "{} {}: {:?}", shader.name, entry.name, written.err());
                }
            }
        }
    }

    #[test]
    fn no_shader_needs_what_webgl_lacks() {
        for shader in ALL {
            for word in ["var<storage", "@compute", "texture_storage"] {
                assert!(!shader.text.contains(word), "{} has {word}", shader.name);
            }
        }
    }
}
