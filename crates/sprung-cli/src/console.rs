//! What is said to a person: results on standard output, everything else on standard error.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::Mutex;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use sprung::Error;
use sprung_io::files::write_error;

/// Why standard output could not be written, once it could not.
static LOST: Mutex<Option<io::Error>> = Mutex::new(None);

/// Writes a line to standard output. A reader that has gone away, as `head` does, is no error; anything else is told by
/// [`lost`] at the end.
pub fn say(line: impl Display) {
    if let Err(error) = writeln!(io::stdout(), "{line}")
        && error.kind() != io::ErrorKind::BrokenPipe
        && let Ok(mut lost) = LOST.lock()
    {
        lost.get_or_insert(error);
    }
}

/// The error of a standard output that lost something that was said.
pub fn lost() -> Option<Error> {
    let error = LOST.lock().ok()?.take()?;
    Some(write_error(Path::new("standard output"), &error))
}

/// Writes a line to standard error.
pub fn note(line: impl Display) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// The one place where errors are printed.
pub fn complain(error: &Error) {
    note(format_args!("sprung: {error}"));
}

/// Help and version as clap has them; a mistake in the arguments as its first paragraph. Gives the exit status.
pub fn usage(error: &clap::Error) -> u8 {
    if !error.use_stderr() {
        let _ = error.print();
        return 0;
    }
    let text = error.to_string();
    let mut paragraphs = text.split("\n\n");
    let first = paragraphs.next().unwrap_or(&text).trim_start_matches("error: ").replace('\n', " ");
    let tip = paragraphs.map(str::trim).find_map(|paragraph| paragraph.strip_prefix("tip: "));
    let first = first.split_whitespace().collect::<Vec<_>>().join(" ");
    note(format_args!("sprung: {first}{}", tip.map(|tip| format!("; {tip}")).unwrap_or_default()));
    note("Try `sprung --help`.");
    2
}

/// A progress bar with the time left; silent when `quiet` or when standard error is no terminal.
pub fn progress(length: u64, what: &'static str, quiet: bool) -> ProgressBar {
    let silent = quiet || !io::stderr().is_terminal();
    let target = if silent { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr_with_hz(10) };
    let bar = ProgressBar::with_draw_target(Some(length), target).with_message(what);
    let style = ProgressStyle::with_template("{msg:>10} {wide_bar} {pos}/{len}  {eta} left");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

/// A number of bytes for people.
pub fn bytes(count: u64) -> String {
    match count {
        0..1_000 => format!("{count} bytes"),
        1_000..1_000_000 => format!("{:.1} kB", count as f64 / 1e3),
        1_000_000..1_000_000_000 => format!("{:.1} MB", count as f64 / 1e6),
        _ => format!("{:.2} GB", count as f64 / 1e9),
    }
}

/// A whole number with its thousands apart: 2,298,240.
pub fn grouped(count: impl TryInto<u64>) -> String {
    let digits = count.try_into().unwrap_or(u64::MAX).to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// One of something, or several: `1 frame`, `2 frames`.
pub fn counted(count: u64, noun: &str) -> String {
    format!("{} {noun}{}", grouped(count), if count == 1 { "" } else { "s" })
}

/// Wall-clock time for people.
pub fn seconds(duration: Duration) -> String {
    format!("{:.2} s", duration.as_secs_f64())
}
