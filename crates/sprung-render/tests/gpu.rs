//! What the graphics card draws, pixel by pixel: things are where they should be, hide each other and stay away.
#![cfg(feature = "gpu")]

mod gpu_support;
mod scenes;

use std::sync::Arc;

use sprung::{Change, Material, ModelBuilder, Params, Plane, Snapshot, SurfaceKind, Vec3};
use sprung_io::RunInfo;
use sprung_render::appearance::{Appearance, ColourBy, Points, Springs, Surfaces, Theme};
use sprung_render::gpu::{Marks, Moment, Quality};

use gpu_support::{Set, apart, device};
use scenes::Motion;

const SIZE: [u32; 2] = [320, 240];
/// Two colours that a person would not call the same.
const DIFFERENT: u32 = 40;
/// Rounding: a channel or two by a step.
const SAME: u32 = 6;

/// A scene of some points and springs that do not move.
fn still(points: &[Vec3], springs: &[[usize; 2]], triangles: Vec<[u32; 3]>) -> Motion {
    let mut builder = ModelBuilder::new();
    for &place in points {
        builder.add_point(place, 1.0).expect("allowed");
    }
    for &[a, b] in springs {
        builder.add_spring(a, b, Material { stiffness: 10.0, damping: 0.0 }).expect("allowed");
    }
    if !triangles.is_empty() {
        builder.add_surface(SurfaceKind::Cloth, triangles).expect("allowed");
    }
    let (model, params, state) = builder.build().expect("sound");
    let positions = state.position.clone();
    let velocities = vec![Vec3::ZERO; positions.len()];
    let info = RunInfo {
        scene: "still".to_owned(),
        title: "Still".to_owned(),
        model: Arc::new(model),
        params,
        frame_time: 0.1,
        frames: 1,
    };
    Motion { info, moments: vec![Snapshot { step: 0, time: 0.0, positions, velocities }] }
}

/// Four points around the middle, joined in pairs.
fn square() -> Motion {
    let points = [
        Vec3::new(-1.0, -1.0, 0.0),
        Vec3::new(1.0, -1.0, 0.0),
        Vec3::new(1.0, 1.0, 0.0),
        Vec3::new(-1.0, 1.0, 0.0),
    ];
    still(&points, &[[0, 1], [2, 3]], Vec::new())
}

/// Radius of the spheres of a few points that are 2 m apart, m.
const RADIUS: f32 = 0.18;

/// A stage with one background colour and no shadows, so that pixels can be told apart.
fn set(what: &str, motion: Motion) -> Option<Set> {
    let mut set = Set::new(device(what)?, motion, SIZE);
    set.look.background = Some(BACKGROUND);
    set.look.shadows = false;
    set.look.springs = Springs::Lines;
    Some(set)
}

const BACKGROUND: [u8; 3] = [201, 214, 37];

fn change(set: &mut Set, change: &Change) {
    let params: &mut Params = &mut set.motion.info.params;
    params.apply(&set.motion.info.model, change).expect("allowed");
    let params = params.clone();
    set.stage.set_params(&params);
}

#[test]
fn a_chosen_background_is_exact() {
    let Some(mut set) = set("the background", square()) else { return };
    for background in [BACKGROUND, [0, 0, 0], [255, 255, 255], [1, 128, 254]] {
        set.look.background = Some(background);
        let image = set.draw();
        for (x, y) in [(0, 0), (319, 0), (0, 239), (319, 239), (160, 2)] {
            assert_eq!(image.pixel(x, y), Some(background));
        }
    }
}

#[test]
fn a_processor_draws_the_same_colours() {
    let Some(set) = set("drawing on a processor", square()) else { return };
    let (look, motion) = (set.look, square());
    let mut quick = Set::of_quality(Quality::Software, set.headless, motion, SIZE);
    quick.look = look;
    for background in [BACKGROUND, [0, 0, 0], [255, 255, 255], [1, 128, 254]] {
        quick.look.background = Some(background);
        assert_eq!(quick.draw().pixel(0, 0), Some(background));
    }
    let image = quick.draw();
    let mut full = Set::new(quick.headless, square(), SIZE);
    full.look = quick.look;
    let expected = full.draw();
    for place in full.positions() {
        let [found, expected] = [&image, &expected].map(|image| full.colour_at(image, place));
        assert!(apart(found, expected) <= SAME, "{found:?} and {expected:?} at {place}");
    }
}

#[test]
fn points_are_where_the_camera_sees_them() {
    let Some(mut set) = set("where points are", square()) else { return };
    set.look.springs = Springs::Hidden;
    let image = set.draw();
    let positions = set.positions();
    for &place in &positions {
        assert!(apart(set.colour_at(&image, place), BACKGROUND) > DIFFERENT, "{place}");
        // Inside its radius the sphere is, outside it is not.
        let [right, up, _] = set.camera.axes;
        for direction in [right, -right, up, -up] {
            let inside = set.colour_at(&image, place + 0.75 * RADIUS * direction);
            assert!(apart(inside, BACKGROUND) > DIFFERENT, "{place}");
            assert_eq!(set.colour_at(&image, place + 1.4 * RADIUS * direction), BACKGROUND);
        }
    }
    change(&mut set, &Change::Pin(1..2, true));
    let pinned = set.draw();
    let [free, fixed] = [0, 1].map(|point: usize| set.colour_at(&pinned, positions[point]));
    assert!(apart(free, fixed) > DIFFERENT, "a fixed point looks different");
    assert_eq!(free, set.colour_at(&image, positions[0]));
}

#[test]
fn what_is_nearer_hides_what_is_behind() {
    let apart_by = |z: f32| {
        still(&[Vec3::ZERO, Vec3::new(0.0, 0.0, z), Vec3::new(3.0, 2.0, 0.0)], &[[0, 2]], Vec::new())
    };
    for z in [-3.0, 3.0] {
        let Some(mut set) = set("what hides what", apart_by(z)) else { return };
        set.look.springs = Springs::Hidden;
        // Straight along z, so that the two points cover each other.
        set.camera.axes = [Vec3::X, Vec3::Y, Vec3::NEG_Z];
        set.camera.eye = Vec3::new(0.0, 0.0, 20.0);
        (set.camera.focal, set.camera.near) = (400.0, 0.1);
        change(&mut set, &Change::Pin(1..2, true));
        let image = set.draw();
        let middle = set.colour_at(&image, Vec3::ZERO);
        let is_dark = middle.iter().all(|&channel| channel < 110);
        assert_eq!(is_dark, z > 0.0, "the fixed point at z = {z} is seen if it is in front: {middle:?}");
    }
}

#[test]
fn a_spring_that_is_cut_vanishes() {
    let Some(mut set) = set("springs that are cut", square()) else { return };
    let middles = [Vec3::new(0.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
    let whole = set.draw();
    assert!(middles.iter().all(|&place| apart(set.colour_at(&whole, place), BACKGROUND) > DIFFERENT));
    change(&mut set, &Change::Cut(1..2, true));
    for springs in [Springs::Lines, Springs::Coils] {
        set.look.springs = springs;
        let image = set.draw();
        assert_eq!(set.colour_at(&image, middles[1]), BACKGROUND);
    }
    change(&mut set, &Change::Cut(1..2, false));
    set.look.springs = Springs::Lines;
    assert_eq!(set.draw(), whole);
}

#[test]
fn half_way_is_in_the_middle() {
    let Some(mut set) = set("moments between two steps", still(&[Vec3::ZERO, Vec3::X], &[], Vec::new()))
    else {
        return;
    };
    set.look.springs = Springs::Hidden;
    let before = [Vec3::new(-2.0, 0.0, 0.0), Vec3::new(0.0, 0.9, 0.0)];
    let now = [Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 0.9, 0.0)];
    set.camera.focal *= 0.3;
    for (blend, x) in [(0.0, -2.0), (0.5, 0.0), (0.75, 1.0), (1.0, 2.0), (f32::NAN, 2.0)] {
        let moment = Moment { before: &before, now: &now, blend, ..Moment::default() };
        let image = set.draw_moment(&moment, &Marks::default());
        for other in [-2.0, 0.0, 1.0, 2.0f32] {
            let is_there = apart(set.colour_at(&image, Vec3::new(other, 0.0, 0.0)), BACKGROUND) > DIFFERENT;
            assert_eq!(is_there, other == x, "blend {blend}, x = {other}");
        }
    }
}

#[test]
fn a_ghost_is_seen_and_seen_through() {
    let Some(mut set) = set("ghosts", square()) else { return };
    let positions = set.positions();
    let ghost: Vec<Vec3> = positions.iter().map(|&place| 0.5 * place).collect();
    let moment = Moment { now: &positions, ghost: &ghost, ..Moment::default() };
    let image = set.draw_moment(&moment, &Marks::default());
    let without = set.draw();
    for (&place, &ghost) in positions.iter().zip(&ghost) {
        let pale = apart(set.colour_at(&image, ghost), BACKGROUND);
        let solid = apart(set.colour_at(&image, place), BACKGROUND);
        assert!(pale > 15 && pale < solid, "{pale} of {solid}");
        assert_eq!(set.colour_at(&without, ghost), BACKGROUND);
    }
}

#[test]
fn places_that_are_not_finite_are_left_out() {
    let points = [Vec3::ZERO, 2.0 * Vec3::X, 2.0 * Vec3::Y, Vec3::new(2.0, 2.0, 0.0)];
    let motion = still(&points, &[[0, 1], [0, 2], [1, 3]], vec![[0, 1, 2], [1, 3, 2]]);
    let Some(mut set) = set("places that are not finite", motion) else { return };
    set.look.points = Points::Spheres;
    let whole = set.draw();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut positions = points;
        positions[3] = Vec3::new(bad, 0.0, 1.0);
        let moment = Moment { now: &positions, ..Moment::default() };
        let image = set.draw_moment(&moment, &Marks::default());
        assert_eq!(set.colour_at(&image, points[3]), BACKGROUND, "{bad}");
        assert_eq!(
            set.colour_at(&image, Vec3::new(1.6, 1.6, 0.0)),
            BACKGROUND,
            "its triangle is gone: {bad}"
        );
        let kept = Vec3::new(0.6, 0.6, 0.0);
        assert!(apart(set.colour_at(&image, kept), BACKGROUND) > DIFFERENT, "the other one is there: {bad}");
    }
    let nowhere = [Vec3::NAN; 4];
    let moment = Moment { now: &nowhere, ..Moment::default() };
    let empty = set.draw_moment(&moment, &Marks::default());
    assert!(empty.rgb.chunks_exact(3).all(|pixel| pixel == BACKGROUND));
    assert_eq!(set.draw(), whole, "and all is well again");
}

#[test]
fn every_mark_changes_the_picture_where_it_should() {
    let Some(mut set) = set("marks", square()) else { return };
    let plain = set.draw();
    let positions = set.positions();
    let moment = Moment { now: &positions, ..Moment::default() };
    let middle = Vec3::new(0.0, -1.0, 0.0);
    let on_spring = [
        Marks { selected_springs: vec![0], ..Marks::default() },
        Marks { hovered_spring: Some(0), ..Marks::default() },
        Marks { alarming_springs: vec![0], ..Marks::default() },
        Marks { pulls: vec![(Vec3::new(-0.5, -1.0, 0.0), Vec3::new(0.5, -1.0, 0.0))], ..Marks::default() },
    ];
    let mut seen = vec![set.colour_at(&plain, middle)];
    for marks in on_spring {
        let colour = set.draw_moment(&moment, &marks);
        let colour = set.colour_at(&colour, middle);
        assert!(apart(colour, seen[0]) > DIFFERENT, "{marks:?}");
        seen.push(colour);
    }
    for marks in [
        Marks { selected_points: vec![0], ..Marks::default() },
        Marks { hovered_point: Some(0), ..Marks::default() },
        Marks { alarming_points: vec![0], ..Marks::default() },
    ] {
        let image = set.draw_moment(&moment, &marks);
        let changed = image.rgb.iter().zip(&plain.rgb).filter(|(a, b)| a != b).count();
        assert!(changed > 60, "{marks:?}");
        assert_eq!(
            set.colour_at(&image, positions[0]),
            set.colour_at(&plain, positions[0]),
            "the point is seen"
        );
    }
    let beyond = Marks {
        selected_points: vec![4, usize::MAX],
        selected_springs: vec![2, usize::MAX],
        hovered_point: Some(9),
        hovered_spring: Some(9),
        pulls: vec![(Vec3::NAN, Vec3::ZERO)],
        ..Marks::default()
    };
    assert_eq!(set.draw_moment(&moment, &beyond), plain, "indices that do not exist are left out");
}

#[test]
fn what_has_sunk_into_a_plane_shines_through() {
    let motion = still(&[Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, -1.0, 0.0)], &[[0, 1]], Vec::new());
    let Some(mut set) = set("planes", motion) else { return };
    set.look.springs = Springs::Hidden;
    let [above, below] = [Vec3::Y, Vec3::NEG_Y];
    let free = set.draw();
    change(&mut set, &Change::Planes(vec![Plane::level(0.0, 1.0, 0.0)]));
    let image = set.draw();
    assert!(
        apart(set.colour_at(&image, above), set.colour_at(&free, above)) <= SAME,
        "nothing in front of it"
    );
    let through = set.colour_at(&image, below);
    assert!(apart(through, set.colour_at(&free, below)) > DIFFERENT, "it is tinted");
    let beside = set.colour_at(&image, below + 3.0 * RADIUS * set.camera.axes[0]);
    assert!(apart(through, beside) > DIFFERENT, "and still seen");
    set.look.ground = false;
    assert_eq!(set.draw(), free);
}

#[test]
fn a_shadow_falls_on_the_plane() {
    let Some(mut set) = set("shadows", scenes::jelly(6, 3)) else { return };
    let off = set.draw();
    set.look.shadows = true;
    let on = set.draw();
    let darker = |(a, b): &(&[u8], &[u8])| b.iter().zip(*a).all(|(b, a)| *b > a.saturating_add(15));
    let count = on.rgb.chunks_exact(3).zip(off.rgb.chunks_exact(3)).filter(darker).count();
    assert!(count > 300, "{count} pixels are darker");
}

#[test]
fn colours_follow_tension() {
    let Some(mut set) = set("colours", square()) else { return };
    set.look.full_scale = 10.0;
    let middle = Vec3::new(0.0, -1.0, 0.0);
    let colour_for = |set: &mut Set, scale: f32| {
        change(set, &Change::RestScale(0..1, scale));
        let image = set.draw();
        set.colour_at(&image, middle)
    };
    // The spring is 2 m long: at half the rest length it is pulled with 10 N, at 1.5 times it is pushed.
    let [pulled, idle, pushed] = [0.5, 1.0, 1.5].map(|scale| colour_for(&mut set, scale));
    assert!(pulled[0] > pulled[2] + 60, "vermilion: {pulled:?}");
    assert!(pushed[2] > pushed[0] + 60, "blue: {pushed:?}");
    assert!(idle[0].abs_diff(idle[2]) < 25, "grey: {idle:?}");
    set.look.colour_by = ColourBy::Plain;
    let plain = [0.5, 1.5].map(|scale| colour_for(&mut set, scale));
    assert_eq!(plain[0], plain[1]);
}

#[test]
fn every_combination_of_choices_can_be_drawn() {
    let Some(mut set) = set("all choices", scenes::cloth(6, 3)) else { return };
    set.size = [64, 48];
    set.camera = gpu_support::camera(&set.positions(), &set.motion.info.params, set.size);
    let mut drawn = 0;
    for (index, points) in Points::ALL.into_iter().enumerate() {
        let theme = Theme::ALL[index % 2];
        {
            for springs in Springs::ALL {
                for surfaces in Surfaces::ALL {
                    for colour_by in ColourBy::ALL {
                        set.look = Appearance { theme, points, springs, surfaces, colour_by, ..set.look };
                        let image = set.draw();
                        let hidden = (points, springs, surfaces)
                            == (Points::Hidden, Springs::Hidden, Surfaces::Hidden);
                        let is_empty = image.rgb.chunks_exact(3).all(|pixel| pixel == BACKGROUND);
                        assert_eq!(is_empty, hidden, "{:?}", set.look);
                        drawn += 1;
                    }
                }
            }
        }
    }
    assert_eq!(drawn, 3 * 4 * 4 * 4);
}

#[test]
fn any_size_and_any_model_can_be_drawn() {
    let Some(mut set) = set("sizes and models", square()) else { return };
    let most = set.headless.device.limits().max_texture_dimension_2d;
    for size in [[0, 0], [0, 100], [1, 1], [3, 700], [most + 1000, 2]] {
        set.size = size;
        let image = set.draw();
        assert_eq!([image.width, image.height], size.map(|side| side.clamp(1, most)));
    }
    set.size = SIZE;
    // One point alone, more points than a row of a table has, and back again.
    let models = [still(&[Vec3::ZERO], &[], Vec::new()), scenes::cloth(50, 2), square()];
    for motion in models {
        set.stage.set_model(&motion.info.model);
        let before = set.positions();
        let moment = Moment { now: &before, ..Moment::default() };
        set.draw_moment(&moment, &Marks::default()); // the old positions, and no parameters yet
        set.stage.set_params(&motion.info.params);
        set.motion = motion;
        set.camera = gpu_support::camera(&set.positions(), &set.motion.info.params, SIZE);
        let image = set.draw();
        let is_empty = image.rgb.chunks_exact(3).all(|pixel| pixel == BACKGROUND);
        assert_eq!(is_empty, set.positions().is_empty());
    }
}
