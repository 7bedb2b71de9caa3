//! How fast it goes, and what keeps it from going faster.

use egui::{RichText, Ui};
use sprung::significant;
use sprung_driver::{Pace, Report};

use super::number::fixed_width;
use crate::theme::Meaning;

/// Below this share of the speed asked for, it is said that the machine cannot keep up.
const KEEPS_UP: f64 = 0.95;

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
    /// Speed, time of a frame, and steps in a second.
    pub fn show(&mut self, ui: &mut Ui, report: &Report) {
        let frame = ui.input(|input| input.unstable_dt);
        self.frame += (frame - self.frame) * if self.frame == 0.0 { 1.0 } else { 1.0 / AVERAGED };
        let speed = speed_text(report);
        let colour = match speed.keeps_up {
            true => ui.visuals().weak_text_color(),
            false => Meaning::Warn.colour(ui.visuals()),
        };
        fixed_width(ui, SPEED_WIDTH, |ui| {
            ui.label(RichText::new(speed.text).monospace().color(colour)).on_hover_text(
                "Simulated seconds for each second. Where a step takes longer than it may, time goes slower: the steps stay \
                 as long as they are, and the motion right.",
            );
        });
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

fn speed_text(report: &Report) -> Speed {
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
    let step = significant((1e5 * report.seconds_per_step).round() / 1e2);
    Speed { text: format!("{shown} × real time: {step} ms a step"), keeps_up: false }
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
        assert_eq!(speed_text(&report).text.trim(), "paused");
        report.playing = true;
        report.seconds_per_step = 0.0123456;
        for (speed, pace, text, keeps_up) in [
            (1.0, Pace::RealTime, "1.00 × real time", true),
            (0.42, Pace::RealTime, "0.42 × real time: 12.35 ms a step", false),
            (0.5, Pace::Slow(2.0), "0.50 × real time", true),
            (0.01, Pace::Slow(100.0), "0.0100 × real time", true),
            (1.0, Pace::Frames, "1.00 × real time: 12.35 ms a step", false),
        ] {
            (report.speed, report.pace) = (speed, pace);
            let found = speed_text(&report);
            assert_eq!((found.text.trim(), found.keeps_up), (text, keeps_up));
        }
    }
}
