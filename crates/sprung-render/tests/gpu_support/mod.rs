//! What all tests of the graphics card share: a device, or a word about what is not tested for want of one.
#![allow(dead_code, reason = "each user takes what it needs")]

use glam::Vec2;
use sprung::{Params, Vec3};
use sprung_render::Image;
use sprung_render::appearance::Appearance;
use sprung_render::camera::{Bounds, Camera};
use sprung_render::gpu::{Headless, Marks, Moment, Quality, Stage, headless};
use sprung_render::turntable::Turntable;

use crate::scenes::Motion;

/// A device. Where there is no driver it prints what is left out, unless `SPRUNG_REQUIRE_GPU` is set: then that is a
/// failure.
#[allow(clippy::print_stderr, reason = "it says what is skipped")]
pub fn device(what: &str) -> Option<Headless> {
    match headless() {
        Ok(headless) => Some(headless),
        Err(error) if std::env::var_os("SPRUNG_REQUIRE_GPU").is_none() => {
            eprintln!("not tested: {what}, as {error}");
            None
        }
        Err(error) => panic!("{what} cannot be tested: {error}"),
    }
}

/// A stage with a scene on it, and a camera that sees all of the scene's last moment.
pub struct Set {
    pub stage: Stage,
    pub headless: Headless,
    pub motion: Motion,
    pub camera: Camera,
    pub look: Appearance,
    pub size: [u32; 2],
}

impl Set {
    pub fn new(headless: Headless, motion: Motion, size: [u32; 2]) -> Self {
        Self::of_quality(Quality::Full, headless, motion, size)
    }

    pub fn of_quality(quality: Quality, headless: Headless, motion: Motion, size: [u32; 2]) -> Self {
        let mut stage = Stage::new(&headless.device, &headless.queue, quality);
        let (model, params) = (&motion.info.model, &motion.info.params);
        stage.set_model(model);
        stage.set_params(params);
        let positions = &motion.moments.last().expect("there is one").positions;
        let camera = camera(positions, params, size);
        let mut look = Appearance::default();
        look.full_scale = Appearance::full_scale_for(model, params, positions, look.colour_by);
        Self { stage, headless, motion, camera, look, size }
    }

    /// Draws the last moment as it is.
    pub fn draw(&mut self) -> Image {
        let positions = self.positions();
        self.draw_moment(&Moment { now: &positions, ..Moment::default() }, &Marks::default())
    }

    pub fn draw_moment(&mut self, moment: &Moment<'_>, marks: &Marks) -> Image {
        self.stage.draw(moment, marks, &self.camera, &self.look, self.size);
        self.stage.read()
    }

    /// Positions of the last moment.
    pub fn positions(&self) -> Vec<Vec3> {
        self.motion.moments.last().expect("there is one").positions.clone()
    }

    /// The pixel of a place.
    pub fn pixel(&self, place: Vec3) -> [u32; 2] {
        let pixel = self.camera.project(place).expect("it is in front of the camera").pixel;
        [pixel.x as u32, pixel.y as u32]
    }

    /// The colour of the pixel of a place.
    pub fn colour_at(&self, image: &Image, place: Vec3) -> [u8; 3] {
        let [x, y] = self.pixel(place);
        image.pixel(x, y).expect("it is in the picture")
    }
}

/// The first view that the window has of some positions and the planes near them.
pub fn camera(positions: &[Vec3], params: &Params, [width, height]: [u32; 2]) -> Camera {
    let mut bounds = Bounds::default();
    positions.iter().for_each(|place| bounds.include(*place));
    for plane in &params.planes {
        let middle = bounds.centre();
        bounds.include(middle + plane.normal * plane.depth(middle));
    }
    let size = Vec2::new(width as f32, height as f32);
    // Room for the spheres, and for a point alone.
    let bounds = bounds.grown(0.1 + 0.08 * bounds.size().length());
    Turntable::framing(&bounds, size.x / size.y).camera(size)
}

/// How far two colours are apart.
pub fn apart(a: [u8; 3], b: [u8; 3]) -> u32 {
    a.iter().zip(b).map(|(a, b)| u32::from(a.abs_diff(b))).sum()
}
