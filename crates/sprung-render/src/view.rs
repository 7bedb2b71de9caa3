//! A scene made into pictures: camera, look and text chosen once for a whole motion, then one picture for each moment.

use std::sync::Arc;

use glam::{Vec2, Vec3};
use rayon::prelude::*;
use sprung::{Model, Params};
use sprung_io::RunInfo;

use crate::camera::Camera;
use crate::colour::{Colour, srgb, to_srgb};
use crate::draw::{Look, Shapes};
use crate::ground::{Ground, Hit, Shadow, nice_step};
use crate::image::Image;
use crate::light::{Studio, backdrop};
use crate::motion::Motion;
use crate::overlay::Overlay;
use crate::raster::{Band, Haze, SAMPLES_4, SAMPLES_8};

/// Rows drawn at a time: few enough for a processor's cache, enough to be worth the setting up.
const BAND_ROWS: usize = 24;

/// How much care goes into edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// Four samples for each pixel, for animations.
    Motion,
    /// Eight samples for each pixel, for single pictures.
    Still,
}

/// Everything about the pictures of one motion that stays the same from frame to frame.
#[derive(Clone, Debug)]
pub struct SceneView {
    model: Arc<Model>,
    size: [u32; 2],
    quality: Quality,
    camera: Camera,
    studio: Studio,
    haze: Haze,
    grounds: Vec<Ground>,
    look: Look,
    overlay: Overlay,
}

impl SceneView {
    /// Chooses camera, look and text for a motion.
    pub fn new(info: &RunInfo, motion: &Motion, quality: Quality) -> Self {
        let (model, params) = (&info.model, &info.params);
        let extent = motion.bounds.grown(0.0).size().max_element();
        let full_force = nice_above(motion.force);
        let mut look = Look::new(model, extent, full_force);
        let bounds = motion.bounds.grown(1.3 * look.ball.max(1e-3 * extent));
        let mut framing = motion.framing();
        framing.grow(1.4 * look.ball);

        // A plane near the motion belongs to the picture, so the place below its middle is framed as well.
        let grounds: Vec<Ground> = params.planes.iter().map(|plane| Ground::new(plane, &bounds)).collect();
        for plane in &params.planes {
            let height = -plane.depth(bounds.centre());
            if height > 0.0 && height < bounds.size().length() {
                framing.include(bounds.centre() - plane.normal * height, 0.0);
            }
        }
        let camera = framing.camera();
        look.choose_detail(model, &camera, bounds.centre());
        let legend = look.any_wires.then_some(full_force);
        let overlay = Overlay::new(info, motion.size, legend, grounds.first().map(Ground::grid));

        let depths = bounds.corners().map(|corner| camera.view(corner).z);
        let (begin, end) =
            depths.iter().fold((f32::MAX, f32::MIN), |(b, e), &depth| (b.min(depth), e.max(depth)));
        // Shallow scenes need no haze to be read.
        let strength = 0.26 * ((end - begin) / begin.max(1e-6) * 2.0).clamp(0.0, 1.0);
        let haze = Haze { colour: srgb(0xe4_ea_f0), begin, end: end.max(begin + 1e-6), strength };
        let studio = Studio::new(&camera, (-params.gravity).normalize_or(Vec3::Y));
        Self {
            model: Arc::clone(model),
            size: motion.size,
            quality,
            camera,
            studio,
            haze,
            grounds,
            look,
            overlay,
        }
    }

    /// The picture of one moment: positions in m, time in s, and the parameters at that time.
    ///
    /// Positions that are missing or not finite are left out.
    pub fn picture(&self, params: &Params, time: f64, positions: &[Vec3]) -> Image {
        let mut image = match self.quality {
            Quality::Motion => self.render(params, positions, &SAMPLES_4),
            Quality::Still => self.render(params, positions, &SAMPLES_8),
        };
        self.overlay.draw(&mut image, time);
        image
    }

    fn render<const N: usize>(&self, params: &Params, positions: &[Vec3], samples: &[Vec2; N]) -> Image {
        let [width, height] = self.size.map(|side| side as usize);
        let mut image = Image { width: self.size[0], height: self.size[1], rgb: vec![0; 3 * width * height] };
        let shapes = if positions.len() == self.model.point_count() {
            self.look.shapes(&self.model, params, positions, &self.camera)
        } else {
            Shapes::default()
        };
        let shadows: Vec<Shadow> =
            self.grounds.iter().map(|ground| ground.shadow(positions, self.look.spacing)).collect();
        let empty = || Band::new(width, 0, 0, samples, &self.studio, self.haze);
        image.rgb.par_chunks_mut(3 * width * BAND_ROWS).enumerate().for_each_init(
            empty,
            |band, (index, bytes)| {
                let (first, rows) = (index * BAND_ROWS, bytes.len() / (3 * width));
                band.restart(first, rows);
                shapes.triangles.iter().for_each(|triangle| band.triangle(triangle));
                shapes.spheres.iter().for_each(|sphere| band.sphere(sphere));
                shapes.capsules.iter().for_each(|wire| band.capsule(wire));
                for (row, bytes) in bytes.chunks_exact_mut(3 * width).enumerate() {
                    self.resolve(band, row, first + row, &shadows, bytes);
                }
            },
        );
        image
    }

    /// Makes pixels of a row's samples: background, shapes, and the translucent planes over both.
    fn resolve<const N: usize>(
        &self,
        band: &Band<'_, N>,
        row: usize,
        y: usize,
        shadows: &[Shadow],
        bytes: &mut [u8],
    ) {
        let [width, height] = self.size.map(|side| side as f32);
        let rays: Vec<_> = self
            .grounds
            .iter()
            .zip(shadows)
            .map(|(ground, shadow)| ground.row(&self.camera, shadow, y as f32 + 0.5))
            .collect();
        let from_middle = 2.0 * (y as f32 + 0.5) / height - 1.0;
        let base = backdrop((y as f32 + 0.5) / height);
        let mut hits: Vec<Hit> = Vec::new();
        for (x, bytes) in bytes.chunks_exact_mut(3).enumerate() {
            let aside = 2.0 * (x as f32 + 0.5) / width - 1.0;
            // A little darker towards the corners.
            let behind = base * (1.0 - 0.03 * (aside * aside + from_middle * from_middle));
            hits.clear();
            hits.extend(rays.iter().filter_map(|ray| ray(x as f32 + 0.5)));
            hits.sort_by(|a, b| b.depth.total_cmp(&a.depth)); // the farthest first
            let through = |depth: f32, colour: Colour| {
                let in_front = hits.iter().filter(|hit| hit.depth < depth);
                in_front.fold(colour, |colour, hit| colour.lerp(hit.colour, hit.alpha))
            };
            let (depths, colours) = band.pixel(x, row);
            let mut sum = Colour::ZERO;
            let mut empty = 0.0;
            for (&depth, &colour) in depths.iter().zip(colours) {
                if depth == f32::INFINITY {
                    empty += 1.0;
                } else {
                    sum += through(depth, colour);
                }
            }
            if empty > 0.0 {
                sum += through(f32::INFINITY, behind) * empty;
            }
            bytes.copy_from_slice(&to_srgb(sum / N as f32));
        }
    }
}

/// The smallest of 1, 2, 5, 10, … (and their fractions) that is not below a force; 1 N where there is none.
fn nice_above(force: f32) -> f32 {
    if force.is_nan() || force <= 1e-6 || force == f32::INFINITY {
        return 1.0;
    }
    let step = nice_step(force);
    if step >= force * 0.999 { step } else { nice_step(2.1 * step).max(nice_step(2.6 * step)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_of_forces_ends_at_a_nice_number() {
        let found = [0.0, 0.9, 1.0, 1.2, 2.4, 6.0, 730.0, f32::NAN].map(nice_above);
        assert_eq!(found, [1.0, 1.0, 1.0, 2.0, 5.0, 10.0, 1000.0, 1.0]);
    }
}
