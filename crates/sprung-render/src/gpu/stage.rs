//! The stage: everything that is needed to draw one model, moment after moment.

use std::sync::Arc;

use glam::{Vec2, Vec3};
use sprung::{Model, Params};
use web_time::Instant;
use wgpu::{Device, Queue};

use super::coarse::coarser;
use super::data::Data;
use super::frame::{self, Light};
use super::passes::{Lens, Passes};
use super::plan::{Basis, Plan};
use super::quality::Quality;
use super::scenery::{Scenery, Sizes};
use super::target::{self, Target};
use super::{Marks, Moment, Reading};
use crate::appearance::Appearance;
use crate::camera::{Bounds, Camera};
use crate::ground::nice_step;
use crate::image::Image;
use crate::surroundings;

/// How long the last drawing took on this side of the card, s. What the card does comes after.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timings {
    /// Blending positions and handing them over.
    pub upload: f64,
    /// Choosing what is drawn and recording it.
    pub encode: f64,
}

/// Pipelines, tables and textures for drawing one model.
///
/// The picture is a texture of format `Rgba8Unorm` whose numbers are sRGB, opaque everywhere: what
/// `egui_wgpu::Renderer::register_native_texture` takes. It is a new texture whenever the size changes; compare
/// [`Stage::texture`] to know when to register it again.
///
/// ```no_run
/// use sprung_render::gpu::{Marks, Moment, Quality, Stage, headless};
/// # fn draw(model: &std::sync::Arc<sprung::Model>, params: &sprung::Params, positions: &[sprung::Vec3],
/// #     camera: &sprung_render::camera::Camera) -> sprung::Result<sprung_render::Image> {
/// let headless = headless()?;
/// let mut stage = Stage::new(&headless.device, &headless.queue, Quality::for_adapter(&headless.info));
/// stage.set_model(model);
/// stage.set_params(params);
/// let moment = Moment { now: positions, ..Moment::default() };
/// stage.draw(&moment, &Marks::default(), camera, &Default::default(), [640, 480]);
/// Ok(stage.read())
/// # }
/// ```
pub struct Stage {
    device: Device,
    queue: Queue,
    quality: Quality,
    passes: Passes,
    data: Data,
    target: Option<Target>,
    model: Option<Arc<Model>>,
    params: Option<Params>,
    plan: Option<(Basis, Plan)>,
    scenery: Scenery,
    /// How much of the sky each point sees, found from the first positions that are drawn.
    openness: Option<Vec<f32>>,
    /// Triangles for surfaces that are to be drawn with fewer of them, found from the same positions.
    coarse: Vec<Option<Vec<[u32; 3]>>>,
    /// Median rest length, m; 0 without springs.
    spacing: f32,
    /// The box around those positions: it sets the grid, which must not change while things move.
    first: Bounds,
    timings: Timings,
}

impl Stage {
    /// Compiles all shaders and makes empty tables. The quality stays; [`Quality::for_adapter`] chooses it.
    pub fn new(device: &Device, queue: &Queue, quality: Quality) -> Self {
        let passes = Passes::new(device, quality);
        let data = Data::new(device, &passes.pipelines.style);
        Self {
            device: device.clone(),
            queue: queue.clone(),
            quality,
            passes,
            data,
            target: None,
            model: None,
            params: None,
            plan: None,
            scenery: Scenery::default(),
            openness: None,
            coarse: Vec::new(),
            spacing: 0.0,
            first: Bounds::default(),
            timings: Timings::default(),
        }
    }

    /// Takes another model, once for each scene. Nothing of it is drawn before [`Stage::set_params`] has been called too.
    pub fn set_model(&mut self, model: &Arc<Model>) {
        self.data.set_model(&self.device, &self.queue, model);
        self.scenery = Scenery::default();
        self.model = Some(Arc::clone(model));
        self.params = None;
        self.plan = None;
        self.openness = None;
        self.coarse.clear();
        self.spacing = surroundings::spacing(model).unwrap_or(0.0);
        self.first = Bounds::default();
    }

    /// Takes the parameters: stiffness, rest lengths, cuts, pins, masses, planes, gravity. Cheap while the long arrays
    /// are those of the last call. Parameters of another model are left out.
    pub fn set_params(&mut self, params: &Params) {
        let Some(model) = &self.model else { return };
        let (points, springs) = (model.point_count(), model.spring_count());
        let fits = params.point_mass.len() == points
            && params.point_pinned.len() == points
            && params.spring_stiffness.len() == springs
            && params.spring_rest_length.len() == springs
            && params.spring_cut.len() == springs;
        if !fits {
            return;
        }
        let unchanged = self.params.as_ref().is_some_and(|old| {
            Arc::ptr_eq(&old.spring_stiffness, &params.spring_stiffness)
                && Arc::ptr_eq(&old.spring_rest_length, &params.spring_rest_length)
                && Arc::ptr_eq(&old.spring_cut, &params.spring_cut)
        });
        if !unchanged {
            self.data.set_springs(&self.queue, params);
        }
        self.params = Some(params.clone());
    }

    /// Draws a moment. The size is in pixels; a side of no pixels becomes one of one pixel, and one beyond what the device
    /// can do becomes the largest possible, with the picture scaled to fit.
    ///
    /// Positions that are not finite are left out. If there are not as many as the model has points, the background alone
    /// is drawn.
    pub fn draw(
        &mut self,
        moment: &Moment<'_>,
        marks: &Marks,
        camera: &Camera,
        appearance: &Appearance,
        size: [u32; 2],
    ) -> &wgpu::TextureView {
        let begin = Instant::now();
        let possible = target::possible(&self.device, size);
        let camera = scaled(camera, size, possible);
        let bounds = self.upload(moment, appearance);
        let uploaded = Instant::now();

        self.choose(appearance);
        let device = &self.device;
        let target = self.target.take().filter(|target| target.size == possible);
        let target = target
            .unwrap_or_else(|| Target::new(device, &self.passes.pipelines.drawn, possible, self.quality));
        let params = self.params.as_ref().filter(|_| bounds.is_some());
        let shown = bounds.unwrap_or_default().grown(0.0);
        let sizes = self.sizes(&shown);
        let lit = shown.grown(1.3 * sizes.ball);
        let light = Light::new(&lit, params.map_or(Vec3::ZERO, |params| params.gravity));
        let lens = Lens {
            camera: &camera,
            appearance,
            moment,
            bounds: &shown,
            sizes,
            params,
            model: self.model.as_deref(),
        };
        let plan = self.plan.as_ref().filter(|_| params.is_some()).map(|(_, plan)| plan);
        self.scenery.set_marks(device, marks, self.model.as_deref());
        let (calls, styles) = self.scenery.calls(plan, &lens);
        let picture = Vec2::new(possible[0] as f32, possible[1] as f32);
        let rows =
            frame::rows(&camera, picture, &light, &lit, params, appearance, self.quality.shadow_side());
        self.data.set_uniforms(&self.queue, &rows, &styles);
        self.data.bind(device, &self.passes.pipelines.tables);
        self.passes.encode(device, &self.queue, &self.data, &target, &calls);
        drop(calls);
        self.timings =
            Timings { upload: (uploaded - begin).as_secs_f64(), encode: uploaded.elapsed().as_secs_f64() };
        &self.target.insert(target).finished_view
    }

    /// The picture that was drawn last.
    pub fn texture(&self) -> Option<&wgpu::Texture> {
        self.target.as_ref().map(|target| &target.finished)
    }

    /// The picture that was drawn last, copied back from the card; empty if none was drawn, or if the card is gone.
    /// It waits for the card, which a browser does not allow: natively only.
    pub fn read(&mut self) -> Image {
        let nothing = Image { width: 0, height: 0, rgb: Vec::new() };
        self.begin_to_read().and_then(Reading::wait).unwrap_or(nothing)
    }

    /// Begins to copy the picture that was drawn last back from the card; `None` if none was drawn.
    pub fn begin_to_read(&mut self) -> Option<Reading> {
        let target = self.target.as_ref()?;
        Some(Reading::begin(&self.device, &self.queue, target))
    }

    /// How long the last drawing took on this side of the card.
    pub fn timings(&self) -> Timings {
        self.timings
    }

    /// How large things are drawn when they fill the box `now`.
    fn sizes(&self, now: &Bounds) -> Sizes {
        let points = self.model.as_ref().map_or(0, |model| model.point_count());
        Sizes::new(points, self.spacing, &self.first, now)
    }

    /// Hands a moment to the card. The box around its points, unless there is nothing that can be drawn.
    fn upload(&mut self, moment: &Moment<'_>, appearance: &Appearance) -> Option<Bounds> {
        let model = self.model.as_ref()?;
        let points = model.point_count();
        if moment.now.len() != points || points == 0 || self.params.is_none() {
            return None;
        }
        if self.openness.is_none() && self.quality.is_coarse() {
            let all = model.with_weighted(moment.now);
            let surfaces = 0..model.surfaces().len();
            self.coarse = surfaces.map(|surface| coarser(&model.triangles_in_list(surface), &all)).collect();
        }
        let openness = self.openness.get_or_insert_with(|| surroundings::openness(model, moment.now));
        // The vertices that points carry come after these.
        let (now, before) = (model.with_weighted(moment.now), model.with_weighted(moment.before));
        let carried = Moment { now: &now, before: &before, ..*moment };
        let mut bounds = self.data.set_positions(&self.queue, &carried, openness);
        if self.first == Bounds::default() {
            self.first = bounds;
        }
        if moment.ghost.len() == points {
            let ghost = model.with_weighted(moment.ghost);
            self.data.set_ghost(&self.device, &self.queue, &ghost, &mut bounds);
        }
        if appearance.velocity_arrows > 0.0 && moment.velocities.len() == points {
            self.data.set_velocities(&self.device, &self.queue, moment.velocities);
        }
        if appearance.force_arrows > 0.0 && moment.forces.len() == points {
            self.data.set_forces(&self.device, &self.queue, moment.forces);
        }
        Some(bounds)
    }

    /// Makes the lists of what is drawn anew if something that they depend on has changed.
    fn choose(&mut self, appearance: &Appearance) {
        let (Some(model), Some(params)) = (&self.model, &self.params) else { return };
        let basis = Basis::new(params, appearance);
        if self.plan.as_ref().is_none_or(|(old, _)| *old != basis) {
            let plan = Plan::new(&self.device, model, params, appearance, &self.coarse);
            self.plan = Some((basis, plan));
        }
    }
}

/// The camera for a picture that had to be smaller than asked for.
fn scaled(camera: &Camera, asked: [u32; 2], possible: [u32; 2]) -> Camera {
    let [x, y] = [0, 1].map(|side| possible[side] as f32 / asked[side].max(1) as f32);
    let smaller = x.min(y);
    Camera { focal: camera.focal * smaller, middle: camera.middle * Vec2::new(x, y), ..*camera }
}

/// Distance of a plane's grid lines for things that reach `half` (m) from their middle.
pub(super) fn grid_for(half: f32) -> f32 {
    nice_step(half.max(1e-6) / 5.0)
}
