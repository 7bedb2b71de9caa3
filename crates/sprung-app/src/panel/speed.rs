//! How fast it goes, and what keeps it from going faster.

use egui::{RichText, Ui};
use sprung::significant;
use sprung_driver::{Pace, Report};

use super::number::fixed_width;
use crate::theme::Meaning;

/// Below this share of the speed asked for, it is said that the machine cannot keep up.
const KEEPS_UP: f64 = 0.95;

/// A window that draws its pictures this much apart is what is slow, unless the steps fill the time, s.
const SLOW_PICTURE: f64 = 0.05;

/// Share of the time that the steps must take to be what is slow.
const STEPS_FILL: f64 = 0.7;

/// Frames over which the time of one is averaged.
const AVERAGED: f32 = 30.0;

/// Room for the longest sentence, so that nothing beside it jumps, points.
const SPEED_WIDTH: f32 = 252.0;

/// Room for the time of a frame and the steps in a second, points.
const STEPS_WIDTH: f32 = 232.0;

/// The speedometer; it averages the time of a frame.
#[derive(Default)]
pub struct Speedometer {
    /// Time of a frame of the window, s.
    frame: f32,
}

impl Speedometer {
    /// Speed; where there is room, time of a frame and steps in a second.
    pub fn show(&mut self, ui: &mut Ui, report: &Report, has_room: bool) {
        let frame = ui.input(|input| input.unstable_dt);
        self.frame += (frame - self.frame) * if self.frame == 0.0 { 1.0 } else { 1.0 / AVERAGED };
        let speed = speed_text(report, self.frame.into());
        let colour = match speed.keeps_up {
            true => ui.visuals().weak_text_color(),
            false => Meaning::Warn.colour(ui.visuals()),
        };
        fixed_width(ui, SPEED_WIDTH, |ui| {
            ui.label(RichText::new(speed.text).monospace().color(colour)).on_hover_text(
                "Simulated seconds for each second. Where a step, or drawing a picture, takes longer than it may, time goes \
                 slower: the steps stay as long as they are, and the motion right.",
            );
        });
        if !has_room {
            return;
        }
        let steps = if report.playing { report.speed / report.params.dt } else { 0.0 };
        let text = format!("{:>5.1} ms/frame {steps:>6.0} steps/s", 1e3 * self.frame);
        fixed_width(ui, STEPS_WIDTH, |ui| {
            ui.label(RichText::new(text).monospace().weak())
                .on_hover_text("Time from one picture to the next, and steps taken in each second.");
        });
    }
}

/// How fast it goes, in words.
struct Speed {
    text: String,
    keeps_up: bool,
}

/// `picture` is the time from one picture of the window to the next, s.
fn speed_text(report: &Report, picture: f64) -> Speed {
    if let Some(busy) = &report.busy {
        return Speed { text: format!("{busy} …"), keeps_up: true };
    }
    if !report.playing {
        return Speed { text: format!("{:<18}", "paused"), keeps_up: true };
    }
    let target = match report.pace {
        Pace::RealTime => 1.0,
        Pace::Frames => 60.0 * report.params.dt * f64::from(report.params.substeps),
        Pace::Slow(times) => 1.0 / times,
    };
    let shown =
        if report.speed < 0.1 { format!("{:.4}", report.speed) } else { format!("{:.2}", report.speed) };
    let text = format!("{:<18}", format!("{shown} × real time"));
    // Nothing measured yet.
    if report.speed == 0.0 || report.speed >= KEEPS_UP * target {
        return Speed { text, keeps_up: true };
    }
    let millis = |seconds: f64| significant((1e5 * seconds).round() / 1e2);
    // Of each second, what the steps would take at the speed asked for.
    let filled = report.seconds_per_step * target / report.params.dt;
    let why = if filled >= STEPS_FILL {
        format!(": {} ms/step", millis(report.seconds_per_step))
    } else if picture >= SLOW_PICTURE {
        format!(": {:.0} ms/picture", 1e3 * picture)
    } else {
        // Neither is slow: something else has the processor.
        String::new()
    };
    Speed { text: format!("{:<18}", format!("{shown} × real time{why}")), keeps_up: false }
}

#[cfg(test)]
mod tests {
    use sprung::scene::Scene;
    use sprung_driver::{Driver, Handle, Source};

    use super::*;

    #[test]
    fn what_cannot_keep_up_says_so() {
        let scene = Scene::builtin("spring").expect("it is built in");
        let source = Source { name: "spring".to_owned(), scene };
        let mut handle = Handle::inline(Driver::new(source).expect("it can be built"));
        let mut report = (*handle.report()).clone();
        assert_eq!(speed_text(&report, 0.02).text.trim(), "paused");
        report.playing = true;
        let dt = report.params.dt;
        let slow = 12.3456 * dt;
        let text_of = |seconds: f64| format!("{} ms/step", significant((1e5 * seconds).round() / 1e2));
        for (speed, pace, step, picture, text, keeps_up) in [
            (1.0, Pace::RealTime, slow, 0.02, "1.00 × real time".to_owned(), true),
            (0.42, Pace::RealTime, slow, 0.02, format!("0.42 × real time: {}", text_of(slow)), false),
            (0.5, Pace::Slow(2.0), slow, 0.02, "0.50 × real time".to_owned(), true),
            (0.01, Pace::Slow(100.0), slow, 0.02, "0.0100 × real time".to_owned(), true),
            // Steps that leave most of the time free are not what is slow.
            (0.42, Pace::RealTime, 0.01 * dt, 0.3, "0.42 × real time: 300 ms/picture".to_owned(), false),
            (0.42, Pace::RealTime, 0.01 * dt, 0.02, "0.42 × real time".to_owned(), false),
            // Both are slow: without the steps, the pictures would come in time.
            (0.42, Pace::RealTime, slow, 0.3, format!("0.42 × real time: {}", text_of(slow)), false),
        ] {
            (report.speed, report.pace, report.seconds_per_step) = (speed, pace, step);
            let found = speed_text(&report, picture);
            assert_eq!((found.text.trim(), found.keeps_up), (text.as_str(), keeps_up));
        }
    }
}
