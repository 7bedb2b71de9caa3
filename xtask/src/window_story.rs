//! What a person does in the window, from the first start to the last: the stage `window`.

use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

use crate::shell::{Outcome, cargo, run, target};
use crate::stages::fresh_folder;
use crate::window::{Display, Window, share_changed};

/// How long the window is left alone while its memory is watched.
const LONG: Duration = Duration::from_secs(60);

/// Memory that a recording of so small a scene takes, bytes: a sample of less than 200 bytes for each step of 0.01 s.
const RECORDING: u64 = LONG.as_secs() * 100 * 200;

/// A picture of the window, as wide and high as it opens, of four bytes a pixel.
const PICTURE: u64 = 4 * 1280 * 820;

/// Memory it may take more after that time, bytes: the recording, and ten pictures that a driver caches. A picture lost
/// every six seconds, or 12 KB with each of sixty a second, would be more.
const GROWTH: u64 = RECORDING + 10 * PICTURE;

/// Less of a picture than this changes by a cursor or a digit.
const SAME: f64 = 2e-3;

/// A scene of one's own, and one with a mistake.
const GOOD_SCENE: &str = "dt = 0.01\n[[body]]\nname = \"stone\"\npoints = [[0, 0, 0]]\npoint_mass = 1\n";
const BAD_SCENE: &str = "dt = 0.01\n[[body]]\nname = \"stone\"\npoints = [[0, 0, 0]]\npoint_mas = 1\n";

/// Everything, on the optimised build.
pub fn run_all() -> Outcome {
    // This one program: the window alone, which is another, would be optimised as a whole as well.
    run(&mut cargo(&["build", "--locked", "--release", "--bin", "sprung"]))?;
    let sprung = target().join("release/sprung");
    let folder = fresh_folder("window")?;
    for (name, text) in [("stone.toml", GOOD_SCENE), ("broken.toml", BAD_SCENE)] {
        fs::write(folder.join(name), text).map_err(|error| format!("{name} cannot be written: {error}"))?;
    }
    let display = Display::start()?;
    for (what, tell) in STORY {
        println!("- {what}");
        tell(&display, &sprung, &folder).map_err(|reason| format!("{what}: {reason}"))?;
    }
    println!("pictures of it are in {}", folder.display());
    Ok(())
}

type Chapter = fn(&Display, &Path, &Path) -> Outcome;

const STORY: &[(&str, Chapter)] = &[
    ("plays, pauses, is pulled, goes back", plays_and_is_pulled),
    ("blows up, is mended, goes on", blows_up_and_goes_on),
    ("refuses a bad file, opens a good one, is resized, quits", opens_files),
    ("comes back with the last scene", comes_back),
    ("takes no more and more memory", does_not_leak),
];

fn plays_and_is_pulled(display: &Display, sprung: &Path, folder: &Path) -> Outcome {
    let mut window = Window::open(display, sprung, &["view", "jelly"], folder)?;
    window.wait_for_title("jelly – sprung")?;
    let before = window.picture("plays")?;
    window.wait_for_change(&before, "plays")?;

    // The first pull takes the hint away.
    let middle = window.middle_of_scene();
    window.drag(middle, (middle.0 + 120, middle.1 - 60))?;
    window.key("space")?;
    window.wait_for_title("paused")?;
    window.key("r")?;
    let start = window.steady("start")?;

    // A hard drag puts the point elsewhere at once. As everything else comes back with the first state, it was the point
    // that moved, and not the camera.
    window.hold("shift", |window| window.drag(middle, (middle.0 + 150, middle.1 - 80)))?;
    let pulled = window.steady("pulled")?;
    if share_changed(&start, &pulled) < SAME {
        return Err("a point that is dragged does not move".to_owned());
    }
    window.key("r")?;
    let again = window.steady("again")?;
    if share_changed(&start, &again) > SAME {
        return Err("the first state does not look as it did at first".to_owned());
    }
    window.quit()
}

fn blows_up_and_goes_on(display: &Display, sprung: &Path, folder: &Path) -> Outcome {
    let mut window = Window::open(display, sprung, &["view", "jelly", "--set", "dt=0.013"], folder)?;
    window.wait_for_title("blew up")?;
    window.picture("blew-up")?;
    // Enter presses the card's first button: mend it, rewind two seconds, go on.
    window.key("Return")?;
    window.wait_for_title("jelly – sprung")?;
    sleep(Duration::from_secs(5));
    let title = window.title()?;
    if title.contains("blew up") {
        return Err("it was mended, and blew up again".to_owned());
    }
    // Back by frames, and to both ends of the record.
    for key in ["z", "z", "z", "Home", "End"] {
        window.key(key)?;
    }
    window.wait_for_title("paused")?;
    window.picture("rewound")?;
    window.quit()
}

fn opens_files(display: &Display, sprung: &Path, folder: &Path) -> Outcome {
    let mut window = Window::open(display, sprung, &["view", "chain"], folder)?;
    window.wait_for_title("chain – sprung")?;
    window.open_file(&folder.join("broken.toml"))?;
    window.wait_for_title("card: That did not work")?;
    window.picture("bad-file")?;
    window.key("Escape")?;
    window.wait_for_title("chain – sprung")?;
    window.open_file(&folder.join("stone.toml"))?;
    window.wait_for_title("stone")?;
    for (width, height) in [(800, 600), (520, 400), (1300, 860)] {
        window.resize(width, height)?;
        sleep(Duration::from_secs(1));
        let bytes = window.picture(&format!("size-{width}x{height}"))?.len();
        if bytes != 3 * (width * height) as usize {
            return Err(format!("the window should be {width} by {height} pixels, and is not"));
        }
    }
    window.quit()
}

fn comes_back(display: &Display, sprung: &Path, folder: &Path) -> Outcome {
    let mut window = Window::open(display, sprung, &[], folder)?;
    window.wait_for_title("stone")?;
    window.quit()
}

fn does_not_leak(display: &Display, sprung: &Path, folder: &Path) -> Outcome {
    let mut window = Window::open(display, sprung, &["view", "spring"], folder)?;
    sleep(LONG / 3);
    let before = window.memory()?;
    sleep(LONG);
    window.must_live()?;
    let after = window.memory()?;
    println!("  {} MiB, and {} MiB after {} s more", before >> 20, after >> 20, LONG.as_secs());
    if after > before + GROWTH {
        return Err(format!("it took {} MiB more in {} s", (after - before) >> 20, LONG.as_secs()));
    }
    window.quit()
}
