//! From what is to be shown to a list of drawings and their styles, back to front where that matters.

use glam::Vec3;
use sprung::{Model, Plane, SurfaceKind};
use wgpu::Device;

use super::data::{List, MOST_STYLES, Source, Style};
use super::frame::{MOST_PLANES, colour, row};
use super::passes::{Call, Lens, Mesh};
use super::pipelines::Pipe;
use super::plan::Plan;
use super::{Marks, stage};
use crate::appearance::ColourBy;
use crate::camera::Bounds;
use crate::palette::{Palette, palette};

/// More springs than this cast no shadow of their own: there is a surface or a crowd of points that does.
const MOST_SHADOWS: u32 = 100_000;
/// More springs than this are thin lines without round ends.
const MOST_ROUND: u32 = 1000;
/// Corners of an arrow.
const ARROW: u32 = 9;
/// Opacity of marks where they are hidden by something.
const FAINT: f32 = 0.3;

/// How large things are drawn, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sizes {
    /// Radius of a point.
    pub ball: f32,
    /// Radius of a spring drawn as a line.
    pub wire: f32,
    /// Median rest length.
    pub spacing: f32,
    /// Distance of the grid's lines.
    pub grid: f32,
    /// How far planes reach from the middle of things.
    pub reach: f32,
}

impl Sizes {
    /// Chooses for a model of so many points and a median rest length, `typical` (m); `first` is the box around its
    /// first positions, `now` that around those of the moment.
    pub fn new(points: usize, typical: f32, first: &Bounds, now: &Bounds) -> Self {
        let half = 0.5 * first.size().max_element();
        let spacing =
            if typical > 0.0 { typical } else { (half / (points as f32).cbrt().max(2.0)).max(0.05) };
        let few = points <= 40;
        // The grid is made for the first box and the fall below it, the sheet for all that is there now.
        let far = half.max(0.5 * now.size().max_element()).max(2.0 * spacing);
        Self {
            ball: if points <= 4 { 0.09 } else { 0.16 } * spacing,
            wire: if few { 0.05 } else { 0.02 } * spacing,
            spacing,
            grid: stage::grid_for(1.7 * half.max(2.0 * spacing)),
            reach: 5.0 * far,
        }
    }
}

/// The lists of what is pointed out.
#[derive(Default)]
struct Marked {
    selected_points: List,
    hovered_point: List,
    alarming_points: List,
    selected_springs: List,
    hovered_spring: List,
    alarming_springs: List,
    pulls: List,
}

/// What is pointed out at the moment.
#[derive(Default)]
pub struct Scenery {
    marks: Marks,
    marked: Marked,
}

impl Scenery {
    /// Uploads the lists of what is pointed out, if it has changed.
    pub fn set_marks(&mut self, device: &Device, marks: &Marks, model: Option<&Model>) {
        let Some(model) = model.filter(|_| self.marks != *marks) else { return };
        let points = |points: &[usize]| {
            let found = points.iter().filter(|&&point| point < model.point_count());
            List::instances(device, &found.map(|&point| point as u32).collect::<Vec<_>>())
        };
        let springs = |springs: &[usize]| {
            let entry = |&spring: &usize| model.springs().get(spring).map(|&[a, b]| [a, b, spring as u32]);
            List::instances(device, &springs.iter().filter_map(entry).collect::<Vec<[u32; 3]>>())
        };
        let is_finite = |(a, b): &&(Vec3, Vec3)| a.is_finite() && b.is_finite();
        let pulls = marks.pulls.iter().filter(is_finite).map(|(a, b)| [a.to_array(), b.to_array()]);
        self.marked = Marked {
            selected_points: points(&marks.selected_points),
            hovered_point: points(marks.hovered_point.as_slice()),
            alarming_points: points(&marks.alarming_points),
            selected_springs: springs(&marks.selected_springs),
            hovered_spring: springs(marks.hovered_spring.as_slice()),
            alarming_springs: springs(&marks.alarming_springs),
            pulls: List::instances(device, &pulls.collect::<Vec<[[f32; 3]; 2]>>()),
        };
        self.marks = marks.clone();
    }

    /// All drawings of a picture, in order, and their styles. Without a plan, the background alone.
    pub fn calls<'a>(&'a self, plan: Option<&'a Plan>, lens: &Lens<'_>) -> (Vec<Call<'a>>, Vec<Style>) {
        let palette = palette(lens.appearance.theme);
        let mut list = Drawings { calls: Vec::new(), styles: Vec::new() };
        let flat = f32::from(u8::from(lens.appearance.background.is_some()));
        let size = [flat, 0.0, 0.0, 0.0];
        list.draw(&[Pipe::Backdrop], Source::Now, Mesh::Vertices(3), Style { size, ..Style::default() });
        if let Some(plan) = plan {
            solid(&mut list, plan, lens, palette);
            grounds(&mut list, lens, palette);
            self.marks(&mut list, plan, lens, palette);
            if lens.model.is_some_and(|model| lens.moment.ghost.len() == model.point_count()) {
                ghost(&mut list, plan, lens, palette);
            }
            self.alarms(&mut list, plan, lens, palette);
        }
        (list.calls, list.styles)
    }

    /// What is selected and under the cursor; where it is hidden by other things it shines through them faintly.
    fn marks<'a>(&'a self, list: &mut Drawings<'a>, plan: &Plan, lens: &Lens<'_>, palette: &Palette) {
        let (marked, thick) = (&self.marked, thickness(plan));
        for (line, ring, opacity) in
            [(Pipe::OverLines, Pipe::OverRings, FAINT), (Pipe::MarkLines, Pipe::MarkRings, 1.0)]
        {
            list.line(line, &marked.selected_springs, lens, (palette.selected, opacity), (thick, 2.0));
            list.line(line, &marked.hovered_spring, lens, (palette.hovered, opacity), (thick, 1.6));
            list.ring(ring, &marked.selected_points, lens, (palette.selected, opacity), 2.4);
            list.ring(ring, &marked.hovered_point, lens, (palette.hovered, opacity), 1.8);
        }
    }

    /// What must be seen through everything.
    fn alarms<'a>(&'a self, list: &mut Drawings<'a>, plan: &Plan, lens: &Lens<'_>, palette: &Palette) {
        let (marked, thick) = (&self.marked, thickness(plan));
        list.line(Pipe::OverSegments, &marked.pulls, lens, (palette.pull, 1.0), (THICK, 1.4));
        list.line(Pipe::OverLines, &marked.alarming_springs, lens, (palette.alarm, 1.0), (thick, 2.2));
        list.ring(Pipe::OverRings, &marked.alarming_points, lens, (palette.alarm, 1.0), 3.0);
    }
}

/// How much thicker than a spring's line its mark is.
const THICK: f32 = 1.6;

/// The same where springs are drawn as coils: a thin line along the axis, which the windings go around.
fn thickness(plan: &Plan) -> f32 {
    if plan.coils { 0.0 } else { THICK }
}

/// A growing list of drawings.
struct Drawings<'a> {
    calls: Vec<Call<'a>>,
    styles: Vec<Style>,
}

impl<'a> Drawings<'a> {
    /// Adds drawings of one thing in one style.
    fn draw(&mut self, pipes: &[Pipe], source: Source, mesh: Mesh<'a>, style: Style) {
        let is_empty = match &mesh {
            Mesh::Vertices(count) => *count == 0,
            Mesh::Instances(_, list) => list.count == 0,
            Mesh::Corners(list, range) => list.count == 0 || range.is_empty(),
            Mesh::Copies(corners, list) => corners.count == 0 || list.count == 0,
        };
        if is_empty || self.styles.len() >= MOST_STYLES {
            return;
        }
        let number = self.styles.len();
        self.styles.push(style);
        let call = |&pipe: &Pipe| Call { pipe, source, style: number, mesh: mesh.clone() };
        self.calls.extend(pipes.iter().map(call));
    }

    /// Adds thick lines of a colour and opacity, at least so many pixels in radius.
    fn line(
        &mut self,
        pipe: Pipe,
        mesh: &'a List,
        lens: &Lens<'_>,
        (hex, opacity): (u32, f32),
        (thick, pixels): (f32, f32),
    ) {
        let size = [thick * lens.sizes.wire, pixels, 1.0, opacity];
        let style = Style { colour: colour(hex, 1.0), size, back: [1.0, 3.0, 0.0, 0.0], ..Style::default() };
        self.draw(&[pipe], Source::Now, Mesh::Instances(4, mesh), style);
    }

    /// Adds rings around points, so many pixels wide.
    fn ring(&mut self, pipe: Pipe, mesh: &'a List, lens: &Lens<'_>, (hex, opacity): (u32, f32), width: f32) {
        let size = [lens.sizes.ball, 5.0, width, 0.0];
        let style = Style { colour: colour(hex, opacity), size, ..Style::default() };
        self.draw(&[pipe], Source::Now, Mesh::Instances(4, mesh), style);
    }
}

/// Points, springs, surfaces and arrows, with the shadows that they cast.
fn solid<'a>(list: &mut Drawings<'a>, plan: &'a Plan, lens: &Lens<'_>, palette: &Palette) {
    let (sizes, appearance) = (&lens.sizes, lens.appearance);
    let is_plain = appearance.colour_by == ColourBy::Plain;
    let with = |main: Pipe, shadow: Pipe, casts: bool| {
        if casts && appearance.shadows { vec![shadow, main] } else { vec![main] }
    };

    for part in &plan.parts {
        let [front, back] = match (part.kind, part.is_pale) {
            (SurfaceKind::Cloth, true) => palette.cloth_pale,
            (SurfaceKind::Cloth, false) => palette.cloth_rich,
            (SurfaceKind::Skin, _) => palette.skin,
        };
        let by_value = f32::from(u8::from(!is_plain && !part.is_pale));
        let style = Style {
            colour: colour(front, 1.0),
            back: colour(back, 1.0),
            size: [by_value, 0.0, 0.0, 1.0],
            ..Style::default()
        };
        let mesh = Mesh::Corners(&plan.corners, part.corners.clone());
        list.draw(&with(Pipe::Surface, Pipe::ShadowSurface, true), Source::Now, mesh, style);
    }

    // Before the springs, so that what they hide is not shaded.
    let style = Style { size: [sizes.ball, 0.9, 0.0, 1.0], ..Style::default() };
    let mesh = Mesh::Instances(4, &plan.points);
    list.draw(&with(Pipe::Points, Pipe::ShadowPoints, true), Source::Now, mesh, style);

    let wire = |hex, radius: f32, pixels: f32, own: bool| Style {
        colour: colour(hex, 1.0),
        size: [radius, pixels, f32::from(u8::from(own)), 1.0],
        back: [0.0, 1.2, 0.0, 0.0],
        ..Style::default()
    };
    if plan.coils {
        let mut style = wire(palette.wire, sizes.ball, 0.75, is_plain);
        style.size[3] = sizes.spacing;
        let mesh = Mesh::Copies(&plan.coil_corners, &plan.springs);
        list.draw(&with(Pipe::Coils, Pipe::ShadowCoils, true), Source::Now, mesh, style);
    } else {
        // On a cloth their shadows would be nothing but dirt.
        let casts = plan.springs.count <= MOST_SHADOWS && plan.parts.is_empty();
        let style = wire(palette.wire, sizes.wire, 0.62, is_plain);
        let mesh = Mesh::Instances(4, &plan.springs);
        list.draw(&with(lines_for(&plan.springs), Pipe::ShadowLines, casts), Source::Now, mesh, style);
    }
    let mut style = wire(palette.edge, 0.5 * sizes.wire, 0.5, true);
    style.back[0] = 1.0; // they are no springs, and cannot be cut
    list.draw(&[lines_for(&plan.edges)], Source::Now, Mesh::Instances(4, &plan.edges), style);

    let count = lens.model.map_or(0, Model::point_count);
    let arrows = [
        (appearance.velocity_arrows, lens.moment.velocities.len(), palette.velocity, 0.0),
        (appearance.force_arrows, lens.moment.forces.len(), palette.force, 1.0),
    ];
    for (scale, len, hex, which) in arrows {
        if scale > 0.0 && scale.is_finite() && len == count {
            let size = [scale, 0.03 * sizes.spacing, 0.8, which];
            let style = Style { colour: colour(hex, 1.0), size, ..Style::default() };
            list.draw(&[Pipe::Arrows], Source::Now, Mesh::Instances(ARROW, &plan.arrows), style);
        }
    }
}

/// How many lines are drawn.
fn lines_for(list: &List) -> Pipe {
    if list.count > MOST_ROUND { Pipe::ThinLines } else { Pipe::Lines }
}

/// Planes, the farthest first.
fn grounds(list: &mut Drawings<'_>, lens: &Lens<'_>, palette: &Palette) {
    let planes = lens.params.map_or(&[][..], |params| &params.planes);
    if !lens.appearance.ground {
        return;
    }
    let centre = lens.bounds.centre();
    let mut sheets: Vec<(f32, Style)> = planes
        .iter()
        .take(MOST_PLANES)
        .map(|plane| {
            let middle = centre + plane.normal * plane.depth(centre);
            (lens.camera.view(middle).z, sheet(plane, middle, lens, palette))
        })
        .collect();
    sheets.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (_, style) in sheets {
        list.draw(&[Pipe::Ground], Source::Now, Mesh::Vertices(4), style);
    }
}

fn sheet(plane: &Plane, middle: Vec3, lens: &Lens<'_>, palette: &Palette) -> Style {
    let normal = plane.normal;
    // Level planes have their grid along x and z.
    let toward = if normal.x.abs() < 0.9 { Vec3::X } else { Vec3::Z };
    let u = (toward - normal * toward.dot(normal)).normalize_or(Vec3::X);
    let of = |(hex, opacity): (u32, f32)| colour(hex, opacity);
    Style {
        colour: of(palette.sheet),
        line: of(palette.grid),
        dark: of(palette.shadow),
        origin: row(middle, lens.sizes.reach),
        along_u: row(u, lens.sizes.grid),
        along_v: row(normal.cross(u), 0.0),
        ..Style::default()
    }
}

/// An earlier run: its front alone, pale, in one colour.
fn ghost<'a>(list: &mut Drawings<'a>, plan: &'a Plan, lens: &Lens<'_>, palette: &Palette) {
    let (hex, opacity) = palette.ghost;
    let pale = colour(hex, opacity);
    let line = Style {
        colour: pale,
        size: [lens.sizes.wire, 0.62, 1.0, opacity],
        back: [0.0, 1.2, 0.0, 0.0],
        ..Style::default()
    };
    let point = Style { colour: pale, size: [lens.sizes.ball, 0.9, 1.0, opacity], ..Style::default() };
    let surface = Style { colour: pale, back: pale, size: [0.0, 0.0, 0.0, opacity], ..Style::default() };
    for pipes in [
        [Pipe::GhostSurfaceDepth, Pipe::GhostLinesDepth, Pipe::GhostPointsDepth],
        [Pipe::GhostSurface, Pipe::GhostLines, Pipe::GhostPoints],
    ] {
        for part in &plan.parts {
            list.draw(
                &pipes[..1],
                Source::Ghost,
                Mesh::Corners(&plan.corners, part.corners.clone()),
                surface,
            );
        }
        list.draw(&pipes[1..2], Source::Ghost, Mesh::Instances(4, &plan.springs), line);
        list.draw(&pipes[2..], Source::Ghost, Mesh::Instances(4, &plan.points), point);
    }
}
