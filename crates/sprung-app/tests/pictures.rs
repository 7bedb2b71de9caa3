//! Pictures of the whole window, compared to stored ones: every scene in both themes, every card, plot and panel, and the
//! README's pictures of the window.
//!
//! `SPRUNG_UPDATE_PICTURES=1 cargo test -p sprung-app --test pictures` draws the stored ones anew; look at them before
//! committing. The newest drawing of each is in `target/tmp`.

mod pictures_support;
mod view_support;

use std::path::{Path, PathBuf};

use egui::Key;
use sprung::{Change, Vec3};
use sprung_app::plots::PlotKind;
use sprung_app::{Action, Pick, Tool};
use sprung_driver::{Command, Edit, Pull};
use sprung_render::appearance::ColourBy;

use pictures_support::compare::compare;
use pictures_support::png_file::write_with_palette;
use pictures_support::squares::updates;
use pictures_support::{Shot, Window, act, can_draw, choose, click, drop_file, enter, play_to};
use view_support::state;

/// The scenes at the moments that the README shows.
const SCENES: &[Shot] = &[
    Shot::light("spring-light", "spring", |window| play_to(window, 1.5)),
    Shot::dark("spring-dark", "spring", |window| play_to(window, 1.5)),
    Shot::light("chain-light", "chain", |window| play_to(window, 2.2)),
    Shot::dark("chain-dark", "chain", |window| play_to(window, 2.2)),
    Shot::light("jelly-light", "jelly", |window| play_to(window, 1.6)),
    Shot::dark("jelly-dark", "jelly", |window| play_to(window, 1.6)),
    Shot::light("cloth-light", "cloth", |window| play_to(window, 2.0)),
    Shot::dark("cloth-dark", "cloth", |window| play_to(window, 2.0)),
];

/// Ways of looking, and what is at hand in the scene.
const VIEWS: &[Shot] = &[
    Shot::light("view-strain", "cloth", |window| {
        state(window).appearance.colour_by = ColourBy::Strain;
        state(window).selection = Some(Pick::Point(210));
        play_to(window, 2.0);
    }),
    Shot::dark("view-pulled", "jelly", |window| {
        pull_a_corner(window);
        play_to(window, 2.0);
    }),
    Shot::light("view-ghost", "chain", |window| {
        play_to(window, 2.0);
        state(window).send(Command::Seek(70));
        state(window).compares = true;
        state(window).send(Command::Compare(true));
        state(window).edit(Edit::new("gravity", vec![Change::Gravity(Vec3::new(0.0, -3.7, 0.0))]));
        play_to(window, 2.0);
    }),
    Shot::dark("view-scissors", "cloth", |window| {
        state(window).tool = Tool::Scissors;
        state(window).edit(Edit::new("cut", vec![Change::Cut(0..120, true)]));
        state(window).selection = Some(Pick::Spring(400));
        play_to(window, 1.0);
    }),
];

/// Every card.
const CARDS: &[Shot] = &[
    Shot::light("card-blow-up", "jelly", blow_up),
    Shot::dark("card-blow-up-dark", "jelly", blow_up),
    Shot::light("card-error", "chain", bad_file),
    Shot::dark("card-help", "chain", |window| act(window, Action::Help)),
    Shot::light("card-open", "spring", |window| act(window, Action::Open)),
    Shot::dark("card-save", "jelly", |window| act(window, Action::Save)),
    Shot::light("card-checkpoint", "jelly", |window| {
        play_to(window, 1.6);
        act(window, Action::Checkpoint);
    }),
    Shot::light("card-checkpoint-bad", "chain", |window| drop_file(window, "half.sprung", "\u{89}not one")),
    Shot::light("card-warnings", "spring", odd_mesh),
    Shot::light("card-replace", "chain", |window| {
        act(window, Action::Save);
        // Any file that is there, and no farther than the question.
        enter(window, "../../scenes/chain.toml");
    }),
    Shot::light("card-motion", "cloth", |window| {
        play_to(window, 1.6);
        act(window, Action::Motion);
    }),
    Shot::light("card-picture", "spring", |window| act(window, Action::Picture)),
    Shot::light("card-hint", "jelly", |window| state(window).hint = true),
];

/// Every kind of plot.
const PLOTS: &[Shot] = &[
    Shot::light("plot-energy", "jelly", energy_of_ten_seconds),
    Shot::dark("plot-stack", "jelly", |window| {
        energy_of_ten_seconds(window);
        click(window, "Stack");
    }),
    Shot::light("plot-trace", "spring", |window| {
        two_traces(window);
        play_to(window, 10.0);
    }),
    Shot::dark("plot-phase", "spring", |window| {
        open_plot(window, PlotKind::Traces);
        // The quantity of the chooser to the right, then another one upwards.
        click(window, "y of point 1");
        choose(window, "height", "velocity upwards");
        click(window, "+ Add to plot");
        play_to(window, 20.0);
    }),
    Shot::dark("plot-formula-spring", "spring", |window| {
        open_plot(window, PlotKind::Formula);
        click(window, "A small swing");
        play_to(window, 20.0);
    }),
    Shot::light("plot-formula-chain", "chain", |window| {
        open_plot(window, PlotKind::Formula);
        click(window, "Bring to rest");
    }),
];

/// What explains.
const EXPLANATIONS: &[Shot] = &[
    Shot::light("explain-scene", "jelly", |window| {
        act(window, Action::Panel);
        act(window, Action::Explain);
        state(window).send(Command::Settle);
    }),
    Shot::dark("explain-stage", "chain", |window| {
        play_to(window, 1.0);
        act(window, Action::Panel);
        (0..3).for_each(|_| act(window, Action::NextStage));
    }),
    Shot::light("explain-lessons", "cloth", |window| {
        act(window, Action::Explain);
        click(window, "Lessons");
    }),
    Shot::dark("explain-quiz", "jelly", |window| {
        act(window, Action::Panel);
        act(window, Action::Explain);
        click(window, "Lessons");
        click(window, "Begin: Make it explode, now explain it");
        (0..6).for_each(|_| skip(window));
        click(window, "Double the damping");
        click(window, "Halve the stiffness of all springs");
    }),
];

/// Windows of other sizes.
const SIZES: &[Shot] = &[
    Shot::dark("size-presentation", "cloth", |window| {
        play_to(window, 2.0);
        act(window, Action::Presentation);
    }),
    Shot::light("size-small", "jelly", |window| {
        play_to(window, 1.6);
        act(window, Action::Plots);
        act(window, Action::Explain);
    })
    .sized([800.0, 600.0], 1.0),
    Shot::dark("size-text-twice", "spring", |window| play_to(window, 1.5)).sized([450.0, 400.0], 2.0),
    Shot::light("size-card-text-twice", "jelly", blow_up).sized([450.0, 400.0], 2.0),
];

/// The README's pictures of the window.
const README: &[Shot] = &[
    Shot::light("window-jelly", "jelly", |window| {
        open_plot(window, PlotKind::Energy);
        play_to(window, 4.5);
        click(window, "Understood");
        pull_a_corner(window);
        play_to(window, 6.5);
    })
    .sized([1280.0, 800.0], 1.0),
    Shot::dark("window-explain", "spring", |window| {
        act(window, Action::Panel);
        open_plot(window, PlotKind::Formula);
        click(window, "A small swing");
        play_to(window, 18.0);
        (0..2).for_each(|_| act(window, Action::NextStage));
    })
    .sized([1280.0, 800.0], 1.0),
    Shot::light("window-blow-up", "jelly", |window| {
        act(window, Action::Panel);
        blow_up(window);
    })
    .sized([1280.0, 800.0], 1.0),
];

/// A jelly whose step is too long, until it blows up.
fn blow_up(window: &mut Window) {
    state(window).edit(Edit::new("dt", vec![Change::Dt(0.0135)]));
    play_to(window, 30.0);
    assert!(state(window).driver.report().trouble.is_some(), "it blows up");
}

fn pull_a_corner(window: &mut Window) {
    let pull = Pull { point: 999, target: Vec3::new(14.0, 14.0, 6.0), hard: false };
    state(window).send(Command::Pull(pull));
}

fn bad_file(window: &mut Window) {
    let text = "dt = 0.01\n\n[[body]]\nname = \"a\"\npoints = [[0, 0]]\npoint_mass = 1.0\n";
    drop_file(window, "two-coordinates.toml", text);
}

/// A mesh with faces too many, too few and too small.
fn odd_mesh(window: &mut Window) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let mesh =
        "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 2 2 3\nv 0 0 0\nv 9 9 9\nf 1 2 3\nf 1 3 4\nf 6 3 5\nf 1 2 2\n";
    let scene = "[[body]]\nname = \"sail\"\nmesh = \"odd.obj\"\npins = [3]\ncloth = { density = 0.4, stiffness = 150 }\n";
    std::fs::write(folder.join("odd.obj"), mesh).expect("it is ours");
    std::fs::write(folder.join("odd.toml"), scene).expect("it is ours");
    act(window, Action::Open);
    enter(window, &folder.join("odd.toml").display().to_string());
    state(window).send(Command::Play(false));
    state(window).send(Command::Reset);
    window.run_steps(3);
}

fn open_plot(window: &mut Window, kind: PlotKind) {
    state(window).plot = kind;
    act(window, Action::Plots);
}

fn energy_of_ten_seconds(window: &mut Window) {
    open_plot(window, PlotKind::Energy);
    play_to(window, 10.0);
}

/// The height of the mass and the length of its spring.
fn two_traces(window: &mut Window) {
    open_plot(window, PlotKind::Traces);
    click(window, "+ Add to plot");
    click(window, "Spring");
    click(window, "+ Add to plot");
}

/// On to the next step of a lesson, whether this one is done or not.
fn skip(window: &mut Window) {
    use egui_kittest::kittest::Queryable;
    let label = if window.query_by_label("Next").is_some() { "Next" } else { "Skip" };
    click(window, label);
    window.key_press(Key::Escape);
    window.run_steps(1);
}

fn stored() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pictures")
}

/// Takes all of them and says of each what is wrong, not only of the first.
fn check(what: &str, shots: &[Shot]) {
    if !can_draw(what) {
        return;
    }
    let wrong: Vec<String> = shots
        .iter()
        .filter_map(|shot| compare(&stored().join(format!("{}.png", shot.name)), &shot.take()))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn scenes() {
    check("the pictures of the scenes", SCENES);
}

#[test]
fn views() {
    check("the pictures of ways of looking", VIEWS);
}

#[test]
fn cards() {
    check("the pictures of the cards", CARDS);
}

#[test]
fn plots() {
    check("the pictures of the plots", PLOTS);
}

#[test]
fn explanations() {
    check("the pictures of what explains", EXPLANATIONS);
}

#[test]
fn sizes() {
    check("the pictures of windows of other sizes", SIZES);
}

/// They are for people, and only drawn anew: what they show is compared above.
#[test]
fn readme() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/pictures");
    for shot in README {
        let path = folder.join(format!("{}.png", shot.name));
        if updates() && can_draw("the README's pictures of the window") {
            write_with_palette(&path, &shot.take());
        }
        let bytes = std::fs::metadata(&path).expect("it is there").len();
        assert!(bytes < 250_000, "{} has {bytes} bytes", path.display());
    }
}

/// A picture whose name has changed would else be stored for ever, and compared with nothing.
#[test]
fn every_stored_picture_is_compared() {
    let tables = [SCENES, VIEWS, CARDS, PLOTS, EXPLANATIONS, SIZES];
    let mut known: Vec<String> =
        tables.into_iter().flatten().map(|shot| format!("{}.png", shot.name)).collect();
    let mut found: Vec<String> = std::fs::read_dir(stored())
        .expect("there are some")
        .map(|entry| entry.expect("it can be read").file_name().to_string_lossy().into_owned())
        .collect();
    known.sort();
    found.sort();
    assert_eq!(known, found);
}
