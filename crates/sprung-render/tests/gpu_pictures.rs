//! Pictures drawn by the graphics card, compared to stored ones.
//!
//! `SPRUNG_UPDATE_PICTURES=1 cargo test -p sprung-render --features gpu` draws the stored ones anew; look at them before
//! committing.
#![cfg(feature = "gpu")]

mod gpu_support;
mod scenes;
mod squares;

use std::path::{Path, PathBuf};

use sprung::{Plane, Vec3};
use sprung_render::Image;
use sprung_render::appearance::{Appearance, ColourBy, Points, Springs, Surfaces, Theme};
use sprung_render::gpu::{Marks, Moment, Quality};

use gpu_support::{Set, device};
use scenes::Motion;

const SIZE: [u32; 2] = [480, 300];
/// Side of the squares in which pictures are compared, pixels.
const SQUARE: u32 = 6;

fn compare(name: &str, found: &Image) {
    let stored = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pictures/gpu").join(format!("{name}.png"));
    let drawn = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("gpu-{name}.png"));
    let write = |path: &Path| {
        let file = std::fs::File::create(path).expect("the picture can be stored");
        sprung_render::export::write_png(std::io::BufWriter::new(file), found).expect("it can be written");
    };
    write(&drawn);
    if squares::updates() {
        std::fs::create_dir_all(stored.parent().expect("it has a folder")).expect("the folder can be made");
        write(&stored);
    }
    let fix = "draw it anew with SPRUNG_UPDATE_PICTURES=1 and look at it";
    let Some(expected) = squares::read(&stored) else {
        panic!("there is no stored picture {}; {fix}", stored.display())
    };
    assert_eq!((found.width, found.height), (expected.width, expected.height), "size of {name}");
    if let Some(what) = squares::too_many(&squares::strays(found, &expected, SQUARE)) {
        panic!("{} differs from {}: {what}; {fix}", drawn.display(), stored.display());
    }
}

/// Draws a scene's last moment in both themes, or in the one that is named.
fn both(name: &str, motion: impl Fn() -> Motion, change: impl Fn(&mut Set)) {
    for theme in Theme::ALL {
        one(&format!("{name}-{}", theme.name()), motion(), |set| {
            set.look.theme = theme;
            change(set);
        });
    }
}

fn one(name: &str, motion: Motion, change: impl Fn(&mut Set)) {
    of_quality(Quality::Full, name, motion, change);
}

fn of_quality(quality: Quality, name: &str, motion: Motion, change: impl Fn(&mut Set)) {
    let Some(headless) = device(&format!("the picture {name}")) else { return };
    let mut set = Set::of_quality(quality, headless, motion, SIZE);
    change(&mut set);
    let by = set.look.colour_by;
    let positions = set.positions();
    let (model, params) = (set.motion.info.model.clone(), set.motion.info.params.clone());
    set.look.full_scale = Appearance::full_scale_for(&model, &params, &positions, by);
    compare(name, &set.draw());
}

#[test]
fn spring() {
    both("spring", || scenes::spring(5), |_| {});
}

#[test]
fn chain() {
    both("chain", || scenes::chain(5), |_| {});
}

#[test]
fn jelly() {
    both("jelly", || scenes::jelly(10, 5), |_| {});
}

#[test]
fn cloth() {
    both("cloth", || scenes::cloth(20, 5), |_| {});
}

#[test]
fn large_models_show_their_surfaces() {
    both("cloth-large", || scenes::cloth(110, 3), |set| set.look.colour_by = ColourBy::Plain);
    both("jelly-large", || scenes::jelly(22, 3), |set| set.look.colour_by = ColourBy::Plain);
}

#[test]
fn colours_mean_what_was_chosen() {
    both(
        "cloth-strain",
        || scenes::cloth(20, 5),
        |set| {
            set.look.colour_by = ColourBy::Strain;
            set.look.points = Points::Hidden;
            set.look.springs = Springs::Hidden;
        },
    );
    both("cloth-energy", || scenes::cloth(20, 5), |set| set.look.colour_by = ColourBy::Energy);
    one("jelly-skin-tension", scenes::jelly(22, 3), |_| {});
}

#[test]
fn surfaces_can_show_their_edges() {
    both(
        "jelly-wireframe",
        || scenes::jelly(10, 5),
        |set| {
            set.look.surfaces = Surfaces::Wireframe;
            set.look.points = Points::Hidden;
            set.look.springs = Springs::Hidden;
            set.look.colour_by = ColourBy::Plain;
        },
    );
}

#[test]
fn everything_can_be_pointed_out() {
    for theme in Theme::ALL {
        let name = format!("marks-{}", theme.name());
        let Some(headless) = device(&format!("the picture {name}")) else { return };
        let mut set = Set::new(headless, scenes::cloth(12, 5), SIZE);
        set.look.theme = theme;
        let positions = set.positions();
        let ghost = set.motion.moments[2].positions.clone();
        let velocities: Vec<Vec3> =
            positions.iter().map(|place| Vec3::new(0.1 * place.z, 1.0, 2.0)).collect();
        let forces: Vec<Vec3> = positions.iter().map(|place| Vec3::new(0.0, -4.0, 0.1 * place.x)).collect();
        (set.look.velocity_arrows, set.look.force_arrows) = (1.0, 0.6);
        let moment = Moment {
            now: &positions,
            velocities: &velocities,
            forces: &forces,
            ghost: &ghost,
            ..Default::default()
        };
        let marks = Marks {
            selected_points: vec![130, 118],
            selected_springs: vec![400, 401],
            hovered_point: Some(66),
            hovered_spring: Some(300),
            alarming_springs: vec![120, 121],
            alarming_points: vec![100],
            pulls: vec![(positions[143], positions[143] + Vec3::new(6.0, 5.0, 0.0))],
        };
        compare(&name, &set.draw_moment(&moment, &marks));
    }
}

#[test]
fn planes_may_lean_and_cross() {
    both(
        "planes",
        || scenes::jelly(6, 5),
        |set| {
            let lean = Vec3::new(0.5, 1.0, 0.0).normalize();
            set.motion.info.params.planes.push(Plane {
                normal: lean,
                point: Vec3::new(-14.0, -10.0, 0.0),
                ..Plane::level(0.0, 50.0, 10.0)
            });
            let params = set.motion.info.params.clone();
            set.stage.set_params(&params);
        },
    );
}

#[test]
fn a_processor_draws_the_same_more_simply() {
    for (name, motion) in [("jelly", scenes::jelly(10, 5)), ("cloth", scenes::cloth(20, 5))] {
        of_quality(Quality::Software, &format!("{name}-software"), motion, |_| {});
    }
    // Enough triangles that fewer are drawn.
    of_quality(Quality::Software, "cloth-large-software", scenes::cloth(110, 3), |set| {
        set.look.colour_by = ColourBy::Plain;
        set.look.theme = Theme::Dark;
    });
}
