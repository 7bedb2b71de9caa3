//! What all shaders know of a picture: camera, light, haze, planes and colours, as rows of four floats.

use glam::{Vec2, Vec3};
use sprung::{Params, Plane};

use crate::appearance::Appearance;
use crate::camera::{Bounds, Camera};
use crate::colour::srgb;
use crate::palette::{Palette, palette};

/// Planes that are drawn; common.wgsl knows it too.
pub const MOST_PLANES: usize = 8;
/// Stops of the colour scale; common.wgsl knows it too.
const STOPS: usize = 9;
/// Colours of points; common.wgsl knows it too.
const BALLS: usize = 8;
/// Rows of the struct `Frame` in common.wgsl.
const ROWS: usize = 19 + STOPS + BALLS + MOST_PLANES;
/// Size of that struct, bytes.
pub const BYTES: u64 = 16 * ROWS as u64;

/// A row: a vector and a number that goes with it.
pub type Row = [f32; 4];

/// A vector and a number in a row.
pub fn row(vector: Vec3, fourth: f32) -> Row {
    [vector.x, vector.y, vector.z, fourth]
}

/// An sRGB colour `0xRRGGBB`, in linear light, and a number in a row.
pub fn colour(hex: u32, fourth: f32) -> Row {
    row(srgb(hex), fourth)
}

/// The lights' directions and what the key light sees.
#[derive(Clone, Copy, Debug)]
pub struct Light {
    /// Unit vectors of its space: across, up, and towards the scene.
    axes: [Vec3; 3],
    centre: Vec3,
    reach: f32,
    up: Vec3,
}

impl Light {
    /// A key light that sees all of `bounds`; `gravity` (m/s²) says what is up.
    pub fn new(bounds: &Bounds, gravity: Vec3) -> Self {
        let up = (-gravity).normalize_or(Vec3::Y);
        // Fixed in the world, so that shadows stay where they are when the camera turns; over the left shoulder of a
        // viewer who stands where the first view has it.
        let aside =
            (Vec3::new(-0.42, 0.0, 0.62) - up * up.dot(Vec3::new(-0.42, 0.0, 0.62))).normalize_or(Vec3::Z);
        let toward = -(up * 1.3 + aside * 0.85).normalize();
        let right = toward.cross(aside).normalize_or(Vec3::X);
        let reach = 1.08 * (0.5 * bounds.size().length()).max(1e-6);
        Self { axes: [right, right.cross(toward), toward], centre: bounds.centre(), reach, up }
    }
}

/// The rows of `Frame`.
pub fn rows(
    camera: &Camera,
    size: Vec2,
    light: &Light,
    bounds: &Bounds,
    params: Option<&Params>,
    appearance: &Appearance,
    shadow_side: u32,
) -> Vec<Row> {
    let palette = palette(appearance.theme);
    let [right, up, forward] = camera.axes;
    let mut rows = Vec::with_capacity(ROWS);
    rows.push(row(camera.eye, camera.near.max(1e-9)));
    rows.push(row(right, camera.focal));
    rows.push(row(up, 0.0));
    rows.push(row(forward, 0.0));
    rows.push([size.x, size.y, camera.middle.x, camera.middle.y]);
    let shadows = f32::from(u8::from(appearance.shadows));
    rows.push(row(light.axes[0], 0.55 * shadows));
    rows.push(row(light.axes[1], shadows));
    rows.push(row(light.axes[2], 0.0));
    rows.push(row(light.centre, light.reach));
    rows.push(row(light.up, 2.0 * light.reach / shadow_side as f32));
    rows.extend([palette.sky, palette.floor, palette.sun].map(|[r, g, b]| [r, g, b, 0.0]));
    push_haze(&mut rows, camera, bounds, params, appearance, palette);
    push_scale(&mut rows, appearance, palette);
    push_planes(&mut rows, params.map_or(&[], |params| params.planes.as_slice()));
    debug_assert_eq!(rows.len(), ROWS);
    rows
}

/// Far parts of a deep scene fade a little into the background.
fn push_haze(
    rows: &mut Vec<Row>,
    camera: &Camera,
    bounds: &Bounds,
    params: Option<&Params>,
    appearance: &Appearance,
    palette: &Palette,
) {
    let depths = bounds.corners().map(|corner| camera.view(corner).z);
    let (begin, end) =
        depths.iter().fold((f32::MAX, f32::MIN), |(b, e), &depth| (b.min(depth), e.max(depth)));
    let begin = begin.max(camera.near);
    let end = end.max(begin * (1.0 + 1e-4) + 1e-6);
    // Shallow scenes need no haze to be read.
    let strength = palette.haze.1 * ((end - begin) / begin.max(1e-6) * 2.0).clamp(0.0, 1.0);
    let haze = appearance.background.map_or(palette.haze.0, |[r, g, b]| u32::from_be_bytes([0, r, g, b]));
    rows.push(colour(haze, strength));
    let planes = params.map_or(0, |params| params.planes.len().min(MOST_PLANES));
    let planes = if appearance.ground { planes } else { 0 };
    rows.push([begin, end, planes as f32, 0.0]);
}

fn push_scale(rows: &mut Vec<Row>, appearance: &Appearance, palette: &Palette) {
    let mode = crate::appearance::ColourBy::ALL.iter().position(|by| *by == appearance.colour_by);
    let signed = appearance.colour_by.is_signed();
    let full = if appearance.full_scale > 1e-30 { appearance.full_scale } else { 1.0 };
    rows.push([mode.unwrap_or(0) as f32, full, f32::from(u8::from(signed)), 0.0]);
    let ([top, bottom], corners) = palette.backdrop;
    let own = appearance.background.map(|[r, g, b]| u32::from_be_bytes([0, r, g, b]));
    rows.push(colour(own.unwrap_or(top), corners));
    rows.push(colour(own.unwrap_or(bottom), 0.0));
    rows.push(colour(palette.waterline.0, palette.waterline.1));
    rows.extend((0..STOPS).map(|stop| {
        let share = stop as f32 / (STOPS - 1) as f32;
        row(appearance.scale_colour(if signed { 2.0 * share - 1.0 } else { share }), 0.0)
    }));
    rows.extend(palette.balls.map(|ball| colour(ball, 0.0)));
    rows.extend([colour(palette.fixed, 0.0), [0.0; 4]]);
}

fn push_planes(rows: &mut Vec<Row>, planes: &[Plane]) {
    let found = planes.iter().map(|plane| row(plane.normal, plane.normal.dot(plane.point)));
    rows.extend(found.chain(std::iter::repeat([0.0; 4])).take(MOST_PLANES));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rows_are_as_many_as_the_shaders_expect() {
        let camera = crate::turntable::Turntable::framing(&Bounds::default(), 1.0).camera(Vec2::splat(100.0));
        let bounds = Bounds::default().grown(0.0);
        let light = Light::new(&bounds, Vec3::ZERO);
        let found = rows(&camera, Vec2::splat(100.0), &light, &bounds, None, &Appearance::default(), 512);
        assert_eq!(found.len() as u64 * 16, BYTES);
        let module =
            wgpu::naga::front::wgsl::parse_str(super::super::shaders::POINTS.text).expect("it is valid");
        let (_, frame) =
            module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some("Frame")).expect("it has one");
        let wgpu::naga::TypeInner::Struct { span, .. } = frame.inner else { panic!("it is a struct") };
        assert_eq!(u64::from(span), BYTES);
    }

    #[test]
    fn the_key_light_comes_from_above_whatever_is_up() {
        for up in [Vec3::Y, Vec3::X, Vec3::NEG_Z, Vec3::new(-0.42, 0.0, 0.62).normalize()] {
            let light = Light::new(&Bounds::default().grown(0.0), -9.81 * up);
            assert!(light.axes[2].dot(up) < -0.5, "{up}: {}", light.axes[2]);
            let [a, b, c] = light.axes;
            assert!(a.dot(b).abs() + b.dot(c).abs() + c.dot(a).abs() < 1e-5);
            assert!(light.axes.iter().all(|axis| (axis.length() - 1.0).abs() < 1e-5));
        }
    }
}
