//! What of a model is drawn, and the lists for it: chosen anew when the model, its pins or the appearance change.

use std::ops::Range;
use std::sync::Arc;

use sprung::{Body, Model, Params, SurfaceKind};
use wgpu::{BufferUsages, Device};

use super::data::List;
use super::topology::edges;
use crate::appearance::{Appearance, ColourBy, Points, Springs, Surfaces};

/// Up to this many springs become coils by themselves.
const COILS: usize = 64;
/// More than this many coils become lines: a coil has two thousand corners.
const MOST_COILS: usize = 2000;
/// Bodies with a surface and more points than this are shown by their surface alone.
const CROWD: usize = 10_000;
/// Fixed points that are marked on a body shown by its surface alone.
const MOST_MARKS: usize = 200;
/// Arrows at most; of more points an even selection.
const MOST_ARROWS: usize = 5000;
/// Corners of a coil: along, and around; coils.wgsl knows them too.
const COIL_SEGMENTS: u32 = 265;
const COIL_SIDES: u32 = 8;

/// Kinds of points, as points.wgsl knows them.
const BALL: u32 = 0;
const FIXED: u32 = 1;
const MARK: u32 = 2;

/// A surface that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its corners in the list of all corners.
    pub corners: Range<u32>,
    /// Open sheet or closed skin.
    pub kind: SurfaceKind,
    /// Whether springs are drawn on it; then it keeps in the background.
    pub is_pale: bool,
}

/// What is drawn of a model.
#[derive(Default)]
pub struct Plan {
    /// Spheres: a point, its kind and its body.
    pub points: List,
    /// Springs: their points and their index.
    pub springs: List,
    /// Whether springs are coils.
    pub coils: bool,
    /// Corners of the coils' triangles.
    pub coil_corners: List,
    /// Corners of the surfaces' triangles.
    pub corners: List,
    /// The surfaces among them.
    pub parts: Vec<Part>,
    /// Edges of triangles, as springs.
    pub edges: List,
    /// Points with arrows.
    pub arrows: List,
}

/// What a plan depends on.
#[derive(Clone)]
pub struct Basis {
    choices: (Points, Springs, Surfaces, bool),
    masses: Arc<Vec<f32>>,
    pins: Arc<Vec<bool>>,
}

impl Basis {
    /// Notes what a plan would depend on.
    pub fn new(params: &Params, appearance: &Appearance) -> Self {
        let is_plain = appearance.colour_by == ColourBy::Plain;
        Self {
            choices: (appearance.points, appearance.springs, appearance.surfaces, is_plain),
            masses: Arc::clone(&params.point_mass),
            pins: Arc::clone(&params.point_pinned),
        }
    }
}

impl PartialEq for Basis {
    fn eq(&self, other: &Self) -> bool {
        let same_arrays = Arc::ptr_eq(&self.masses, &other.masses) && Arc::ptr_eq(&self.pins, &other.pins);
        self.choices == other.choices && same_arrays
    }
}

/// Which parts of a body are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shown {
    /// Its points, as spheres.
    pub points: bool,
    /// Its springs, as lines or coils.
    pub springs: bool,
    /// Its open sheets.
    pub cloths: bool,
    /// Its closed skins.
    pub skins: bool,
}

impl Shown {
    /// Whether a surface of this kind is drawn.
    pub fn surface(self, kind: SurfaceKind) -> bool {
        match kind {
            SurfaceKind::Cloth => self.cloths,
            SurfaceKind::Skin => self.skins,
        }
    }
}

impl Plan {
    /// Chooses what is drawn, and uploads the lists.
    ///
    /// `coarse` holds triangles for surfaces that are to be drawn with fewer of them.
    pub fn new(
        device: &Device,
        model: &Model,
        params: &Params,
        appearance: &Appearance,
        coarse: &[Option<Vec<[u32; 3]>>],
    ) -> Self {
        let shown: Vec<Shown> =
            (0..model.bodies().len()).map(|body| shown(model, appearance, body)).collect();
        let springs = chosen_springs(model, appearance, &shown);
        let coils = match appearance.springs {
            Springs::Auto => springs.len() <= COILS,
            Springs::Coils => springs.len() <= MOST_COILS,
            _ => false,
        };
        let (parts, corners) = chosen_surfaces(model, appearance, &shown, coarse);
        let wireframe = appearance.surfaces == Surfaces::Wireframe;
        let edges: Vec<[u32; 3]> = if wireframe {
            let surfaces = 0..model.surfaces().len();
            surfaces
                .flat_map(|surface| edges(&model.triangles_in_list(surface)))
                .map(|[a, b]| [a, b, 0])
                .collect()
        } else {
            Vec::new()
        };
        let coil_corners = if coils && !springs.is_empty() { coil_corners() } else { Vec::new() };
        let stride = model.point_count().div_ceil(MOST_ARROWS).max(1);
        let arrows: Vec<u32> = (0..model.point_count() as u32).step_by(stride).collect();
        Self {
            points: List::instances(device, &chosen_points(model, params, appearance, &shown)),
            springs: List::instances(device, &springs),
            coils,
            coil_corners: List::new(device, &coil_corners, BufferUsages::INDEX),
            corners: List::new(device, &corners, BufferUsages::INDEX),
            parts,
            edges: List::instances(device, &edges),
            arrows: List::instances(device, &arrows),
        }
    }
}

fn is_crowded(body: &Body) -> bool {
    body.points.len() > CROWD
}

/// Which parts of a body are drawn, by its index in the model: what the appearance asks for, and where that is left open,
/// what can be seen. What is drawn can be picked; so the window asks the same function.
pub fn shown(model: &Model, appearance: &Appearance, body: usize) -> Shown {
    let has_surface = appearance.surfaces != Surfaces::Hidden
        && model.surfaces().iter().any(|surface| surface.body == body);
    let is_covered = model.bodies().get(body).is_some_and(is_crowded) || model.is_seen_by_surface(body);
    let in_detail = !(has_surface && is_covered);
    let points = match appearance.points {
        Points::Auto => in_detail,
        Points::Spheres => true,
        Points::Hidden => false,
    };
    let springs = match appearance.springs {
        Springs::Auto => in_detail,
        Springs::Lines | Springs::Coils => true,
        Springs::Hidden => false,
    };
    let skins = match appearance.surfaces {
        Surfaces::Hidden => false,
        // Inside the skin of a solid shown in detail nothing could be seen.
        Surfaces::Auto => !(points || springs),
        Surfaces::Filled | Surfaces::Wireframe => true,
    };
    Shown { points, springs, cloths: appearance.surfaces != Surfaces::Hidden, skins }
}

/// Whether springs of joints are drawn: they lie between bodies, where no surface could stand for them. The window asks the
/// same function.
pub fn joints_shown(appearance: &Appearance) -> bool {
    appearance.springs != Springs::Hidden
}

fn chosen_points(model: &Model, params: &Params, appearance: &Appearance, shown: &[Shown]) -> Vec<[u32; 2]> {
    let mut points = Vec::new();
    for ((body, shown), index) in model.bodies().iter().zip(shown).zip(0u32..) {
        let kind = |fixed: bool, index: u32| index << 8 | if fixed { FIXED } else { BALL };
        if shown.points {
            points
                .extend(body.points.clone().map(|point| [point as u32, kind(params.is_fixed(point), index)]));
        } else if appearance.points == Points::Auto {
            // Of a body shown by its surface alone, only the fixed points are marked, large enough to be seen.
            let fixed = body.points.clone().filter(|&point| params.is_fixed(point));
            points.extend(fixed.take(MOST_MARKS).map(|point| [point as u32, index << 8 | MARK]));
        }
    }
    points
}

fn chosen_springs(model: &Model, appearance: &Appearance, shown: &[Shown]) -> Vec<[u32; 3]> {
    let bodies = model.bodies().iter().zip(shown).filter(|(_, shown)| shown.springs);
    let joints = model.joints().iter().filter(|_| joints_shown(appearance));
    let ranges =
        bodies.map(|(body, _)| body.springs.clone()).chain(joints.map(|joint| joint.springs.clone()));
    let entry = |spring: usize| {
        let [a, b] = model.springs()[spring];
        [a, b, spring as u32]
    };
    ranges.flatten().map(entry).collect()
}

fn chosen_surfaces(
    model: &Model,
    appearance: &Appearance,
    shown: &[Shown],
    coarse: &[Option<Vec<[u32; 3]>>],
) -> (Vec<Part>, Vec<u32>) {
    let (mut parts, mut corners) = (Vec::new(), Vec::new());
    for (index, surface) in model.surfaces().iter().enumerate() {
        let shown = shown[surface.body];
        if shown.surface(surface.kind) {
            let first = corners.len() as u32;
            // Springs and edges would not lie on a coarser one.
            let is_bare = !shown.springs && appearance.surfaces != Surfaces::Wireframe;
            let fewer = coarse.get(index).and_then(Option::as_ref).filter(|_| is_bare);
            match fewer {
                Some(fewer) => corners.extend(fewer.iter().flatten()),
                None => corners.extend(model.triangles_in_list(index).iter().flatten()),
            }
            let is_pale = shown.springs && surface.kind == SurfaceKind::Cloth;
            parts.push(Part { corners: first..corners.len() as u32, kind: surface.kind, is_pale });
        }
    }
    (parts, corners)
}

/// Two triangles for each square of a tube's skin.
fn coil_corners() -> Vec<u32> {
    let squares = (0..COIL_SEGMENTS).flat_map(|along| (0..COIL_SIDES).map(move |around| (along, around)));
    let corner = |along: u32, around: u32| along * COIL_SIDES + around % COIL_SIDES;
    squares
        .flat_map(|(s, t)| {
            let [a, b, c, d] = [corner(s, t), corner(s + 1, t), corner(s + 1, t + 1), corner(s, t + 1)];
            [a, b, c, a, c, d]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::{Material, ModelBuilder, Vec3};

    /// A triangle of cloth with its springs.
    fn model() -> (Model, Params) {
        let mut builder = ModelBuilder::new();
        for place in [Vec3::ZERO, Vec3::X, Vec3::Y] {
            builder.add_point(place, 1.0).expect("allowed");
        }
        let material = Material { stiffness: 1.0, damping: 0.0 };
        for [a, b] in [[0, 1], [1, 2], [0, 2]] {
            builder.add_spring(a, b, material).expect("allowed");
        }
        builder.add_surface(SurfaceKind::Cloth, vec![[0, 1, 2]]).expect("allowed");
        builder.pin(1).expect("allowed");
        let (model, params, _) = builder.build().expect("sound");
        (model, params)
    }

    #[test]
    fn every_choice_is_followed() {
        let (model, params) = model();
        for points in Points::ALL {
            for springs in Springs::ALL {
                for surfaces in Surfaces::ALL {
                    let appearance = Appearance { points, springs, surfaces, ..Default::default() };
                    let shown = [shown(&model, &appearance, 0)];
                    let balls = chosen_points(&model, &params, &appearance, &shown);
                    assert_eq!(balls.len(), if points == Points::Hidden { 0 } else { 3 });
                    let wires = chosen_springs(&model, &appearance, &shown);
                    assert_eq!(wires.len(), if springs == Springs::Hidden { 0 } else { 3 });
                    let (parts, corners) = chosen_surfaces(&model, &appearance, &shown, &[]);
                    let expected = usize::from(surfaces != Surfaces::Hidden);
                    assert_eq!((parts.len(), corners.len()), (expected, 3 * expected));
                    assert!(parts.iter().all(|part| part.is_pale == (springs != Springs::Hidden)));
                }
            }
        }
    }

    #[test]
    fn fixed_points_are_told_apart() {
        let (model, params) = model();
        let shown = [Shown { points: true, springs: true, ..Shown::default() }];
        let balls = chosen_points(&model, &params, &Appearance::default(), &shown);
        assert_eq!(balls, [[0, BALL], [1, FIXED], [2, BALL]]);
    }

    #[test]
    fn a_coil_has_as_many_corners_as_its_shader_expects() {
        let text = super::super::shaders::COILS.text;
        assert!(text.contains(&format!("const SEGMENTS = {COIL_SEGMENTS}u;")));
        assert!(text.contains(&format!("const SIDES = {COIL_SIDES}u;")));
        let corners = coil_corners();
        assert_eq!(corners.iter().max(), Some(&((COIL_SEGMENTS + 1) * COIL_SIDES - 1)));
    }
}
