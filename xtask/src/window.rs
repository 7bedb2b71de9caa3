//! A real window on a virtual display, driven as a person would: keys, mouse, files, resizing, closing.
//!
//! What the window is doing is read from its title, its pixels, its standard error and its memory.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::shell::{Outcome, program, quiet};

/// Longest wait for anything that should happen. Generous: a software driver on a busy machine is slow.
const PATIENCE: Duration = Duration::from_secs(120);

/// The virtual screen, pixels.
const SCREEN: (u32, u32) = (1400, 900);

/// A virtual display; gone when dropped.
pub struct Display {
    server: Child,
    name: String,
}

impl Display {
    /// Starts one on a free number.
    pub fn start() -> Outcome<Self> {
        let screen = format!("{}x{}x24", SCREEN.0, SCREEN.1);
        let mut server =
            program("Xvfb", &["-displayfd", "1", "-screen", "0", &screen, "-nolisten", "tcp", "-noreset"])
                .stdout(Stdio::piped())
                .stderr(Stdio::null())
                .spawn()
                .map_err(|error| format!("Xvfb cannot be started: {error}"))?;
        let stdout = server.stdout.take().ok_or("Xvfb has no output")?;
        let mut number = String::new();
        BufReader::new(stdout)
            .read_line(&mut number)
            .map_err(|error| format!("Xvfb does not say its number: {error}"))?;
        Ok(Self { server, name: format!(":{}", number.trim()) })
    }

    /// As the environment variable DISPLAY has it.
    pub fn name(&self) -> &str {
        &self.name
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// Somewhere in the middle of the scene of a window of the usual size, pixels.
const MIDDLE: (i32, i32) = (800, 400);

/// Beside the buttons of the bar.
const ASIDE: (i32, i32) = (1240, 15);

/// The program with its window.
pub struct Window<'a> {
    display: &'a Display,
    process: Child,
    id: String,
    folder: PathBuf,
}

impl<'a> Window<'a> {
    /// Starts `sprung` with some arguments in a folder, which is its home too, and waits for the window.
    pub fn open(display: &'a Display, sprung: &Path, arguments: &[&str], folder: &Path) -> Outcome<Self> {
        let log =
            fs::File::create(folder.join("stderr.txt")).map_err(|error| format!("no log file: {error}"))?;
        let process = Command::new(sprung)
            .args(arguments)
            .current_dir(folder)
            .env("DISPLAY", &display.name)
            .env("HOME", folder)
            .env("XDG_DATA_HOME", folder.join("data"))
            .env("XDG_CONFIG_HOME", folder.join("config"))
            .env("XDG_RUNTIME_DIR", folder)
            .env_remove("WAYLAND_DISPLAY")
            .stderr(log)
            .stdout(Stdio::null())
            .spawn()
            .map_err(|error| format!("{} cannot be started: {error}", sprung.display()))?;
        let mut window = Self { display, process, id: String::new(), folder: folder.to_owned() };
        let begun = Instant::now();
        while window.id.is_empty() {
            if begun.elapsed() > PATIENCE {
                return Err(format!("no window appeared; {}", window.log()));
            }
            if let Ok(Some(status)) = window.process.try_wait() {
                return Err(format!("it ended with {status} before a window appeared; {}", window.log()));
            }
            let found = quiet(&mut window.xdotool(&["search", "--onlyvisible", "--name", "sprung"]));
            let ids = found.map(|ids| String::from_utf8_lossy(&ids).into_owned()).unwrap_or_default();
            window.id = ids.lines().next().unwrap_or_default().to_owned();
            sleep(Duration::from_millis(100));
        }
        // There is no window manager that would give it the keyboard.
        quiet(&mut window.xdotool(&["windowfocus", "--sync", &window.id]))?;
        Ok(window)
    }

    /// Presses a key, such as `space` or `ctrl+o`.
    pub fn key(&self, key: &str) -> Outcome {
        quiet(&mut self.xdotool(&["key", "--clearmodifiers", key])).map(drop)
    }

    /// Types text.
    pub fn text(&self, text: &str) -> Outcome {
        quiet(&mut self.xdotool(&["type", "--delay", "30", text])).map(drop)
    }

    /// Drags with the left button, in a few moves as a hand does.
    pub fn drag(&self, from: (i32, i32), to: (i32, i32)) -> Outcome {
        let place = |(x, y): (i32, i32)| {
            quiet(&mut self.xdotool(&["mousemove", "--window", &self.id, &x.to_string(), &y.to_string()]))
        };
        place(from)?;
        sleep(Duration::from_millis(300));
        quiet(&mut self.xdotool(&["mousedown", "1"]))?;
        for part in 1..=10 {
            place((from.0 + (to.0 - from.0) * part / 10, from.1 + (to.1 - from.1) * part / 10))?;
            sleep(Duration::from_millis(60));
        }
        sleep(Duration::from_millis(500));
        quiet(&mut self.xdotool(&["mouseup", "1"])).map(drop)
    }

    /// Does something while a key is held.
    pub fn hold(&self, key: &str, act: impl FnOnce(&Self) -> Outcome) -> Outcome {
        quiet(&mut self.xdotool(&["keydown", key]))?;
        let outcome = act(self);
        quiet(&mut self.xdotool(&["keyup", key]))?;
        outcome
    }

    /// Opens a file by its path, through the card.
    pub fn open_file(&mut self, path: &Path) -> Outcome {
        self.key("ctrl+o")?;
        self.wait_for_title("card: Open a scene")?;
        self.text(&path.display().to_string())?;
        self.key("Return")
    }

    /// The middle of the scene, right of the panel, pixels.
    pub fn middle_of_scene(&self) -> (i32, i32) {
        MIDDLE
    }

    /// Its picture once nothing moves any more, with the cursor where it points at nothing.
    pub fn steady(&mut self, name: &str) -> Outcome<Vec<u8>> {
        let begun = Instant::now();
        let [x, y] = [ASIDE.0, ASIDE.1].map(|place| place.to_string());
        quiet(&mut self.xdotool(&["mousemove", "--window", &self.id, &x, &y]))?;
        sleep(Duration::from_millis(500));
        let mut before = self.picture(name)?;
        loop {
            sleep(Duration::from_millis(1500));
            let now = self.picture(name)?;
            if share_changed(&before, &now) == 0.0 {
                return Ok(now);
            }
            self.must_live()?;
            if begun.elapsed() > PATIENCE {
                return Err(format!("{name}: the window does not come to rest"));
            }
            before = now;
        }
    }

    /// Makes it another size.
    pub fn resize(&self, width: u32, height: u32) -> Outcome {
        quiet(&mut self.xdotool(&["windowsize", &self.id, &width.to_string(), &height.to_string()])).map(drop)
    }

    /// The title.
    pub fn title(&self) -> Outcome<String> {
        Ok(String::from_utf8_lossy(&quiet(&mut self.xdotool(&["getwindowname", &self.id]))?)
            .trim()
            .to_owned())
    }

    /// Waits until the title contains something.
    pub fn wait_for_title(&mut self, part: &str) -> Outcome {
        let begun = Instant::now();
        while !self.title()?.contains(part) {
            self.must_live()?;
            if begun.elapsed() > PATIENCE {
                let title = self.title()?;
                return Err(format!(
                    "the title should contain \"{part}\", and is \"{title}\"; {}",
                    self.log()
                ));
            }
            sleep(Duration::from_millis(100));
        }
        Ok(())
    }

    /// Its pixels, as bytes of red, green and blue, and kept as a picture beside the log.
    pub fn picture(&self, name: &str) -> Outcome<Vec<u8>> {
        let file = self.folder.join(format!("{name}.png")).display().to_string();
        quiet(self.on_display(&mut program("import", &["-window", &self.id, &file])))?;
        quiet(&mut program("convert", &[&file, "-depth", "8", "rgb:-"]))
    }

    /// Waits until it looks different from a picture of the same size.
    pub fn wait_for_change(&mut self, before: &[u8], name: &str) -> Outcome {
        let begun = Instant::now();
        loop {
            if share_changed(before, &self.picture(name)?) > 1e-3 {
                return Ok(());
            }
            self.must_live()?;
            if begun.elapsed() > PATIENCE {
                return Err(format!("{name}: nothing changed in the window"));
            }
            sleep(Duration::from_millis(200));
        }
    }

    /// Memory in use, bytes.
    pub fn memory(&self) -> Outcome<u64> {
        let path = format!("/proc/{}/status", self.process.id());
        let status = fs::read_to_string(&path).map_err(|error| format!("{path} cannot be read: {error}"))?;
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap_or_default();
        let kilobytes = line.trim().trim_end_matches("kB").trim().parse::<u64>();
        kilobytes.map(|count| 1024 * count).map_err(|error| format!("{path}: {error}"))
    }

    /// Fails if the program has ended or panicked.
    pub fn must_live(&mut self) -> Outcome {
        let log = self.log();
        if log.contains("panicked") {
            return Err(log);
        }
        match self.process.try_wait() {
            Ok(None) => Ok(()),
            Ok(Some(status)) => Err(format!("it ended with {status}; {log}")),
            Err(error) => Err(format!("it cannot be waited for: {error}")),
        }
    }

    /// Asks it to quit by its key, and waits until it has, well.
    pub fn quit(mut self) -> Outcome {
        self.must_live()?;
        self.key("ctrl+q")?;
        let begun = Instant::now();
        loop {
            match self.process.try_wait() {
                Ok(Some(status)) if status.success() => return Ok(()),
                Ok(Some(status)) => return Err(format!("it ended with {status}; {}", self.log())),
                _ if begun.elapsed() > PATIENCE => return Err("it does not quit".to_owned()),
                _ => sleep(Duration::from_millis(100)),
            }
        }
    }

    /// What it said on standard error.
    fn log(&self) -> String {
        let log = fs::read_to_string(self.folder.join("stderr.txt")).unwrap_or_default();
        format!("it said: {}", if log.trim().is_empty() { "nothing" } else { log.trim() })
    }

    fn xdotool(&self, arguments: &[&str]) -> Command {
        let mut command = program("xdotool", arguments);
        self.on_display(&mut command);
        command
    }

    fn on_display<'c>(&self, command: &'c mut Command) -> &'c mut Command {
        command.env("DISPLAY", &self.display.name)
    }
}

impl Drop for Window<'_> {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// The share of bytes that differ visibly between two pictures; all of them if the sizes differ.
pub fn share_changed(a: &[u8], b: &[u8]) -> f64 {
    if a.len() != b.len() || a.is_empty() {
        return 1.0;
    }
    let changed = a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) > 8).count();
    changed as f64 / a.len() as f64
}
