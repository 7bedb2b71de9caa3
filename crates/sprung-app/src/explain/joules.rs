//! The lesson about the energy ledger: where the energy of a swinging mass goes.

use sprung::scene::Scene;
use sprung::{Change, Result, significant};
use sprung_driver::{Command, Edit, Pace};

use super::lesson::{Lesson, LessonStep, Memory, Offer};
use super::quiz::{Answer, Quiz};
use crate::action::Action;
use crate::plots::PlotKind;
use crate::state::AppState;
use crate::text::with_minus;

/// A step so long that the integrator's error is seen, s.
const LONG: f64 = 0.1;

/// The lesson.
pub const LESSON: Lesson = Lesson {
    title: "Where does the energy go?",
    about: "A mass on a spring, and the books of its energy: what changes form, what is lost, and what the computer itself makes.",
    steps: &[
        LessonStep {
            title: "A mass on a spring",
            text: |_, _| "Open the mass on a spring. It starts with a push to the side.".to_owned(),
            offers: &[Offer {
                label: "Open the spring",
                act: |state| {
                    state.act(Action::Scene(0));
                    state.send(Command::Play(true));
                },
            }],
            done: |state, _| state.report.opened.name == "spring",
            quiz: None,
        },
        LessonStep {
            title: "Open the books",
            text: |_, _| "Show the plots (key G), and among them the energy.".to_owned(),
            offers: &[Offer { label: "Show the energy plot", act: show_plot }],
            done: |state, _| state.shown.plots && state.plot == PlotKind::Energy,
            quiz: None,
        },
        LessonStep {
            title: "Forms of energy",
            text: |_, _| {
                "Let it play for five seconds. Falling turns height into motion; at the bottom motion turns into stretch; the spring \
                 gives it back. Each line goes up and down, and where one rises others fall."
                    .to_owned()
            },
            offers: &[Offer { label: "Let it play", act: |state| state.send(Command::Play(true)) }],
            done: |state, memory| memory.elapsed(state) >= 5.0,
            quiz: None,
        },
        LessonStep { title: "What is lost", text: lost, offers: &[], done: |_, _| true, quiz: None },
        LessonStep {
            title: "Without a damper",
            text: |_, _| {
                "Set the damping to zero and play on for three seconds. The total is flat now: nothing takes energy out any more. \
                 (At the change itself nothing jumps, since a damper stores no energy.)"
                    .to_owned()
            },
            offers: &[Offer {
                label: "Damping 0",
                act: |state| {
                    let all = 0..state.report.opened.model.spring_count();
                    state.edit(Edit::new("damping", vec![Change::Damping(all, 0.0)]));
                    state.send(Command::Play(true));
                },
            }],
            done: |state, memory| {
                let undamped = state.report.params.spring_damping.iter().all(|damping| *damping == 0.0);
                undamped && memory.elapsed(state) >= 3.0
            },
            quiz: None,
        },
        LessonStep {
            title: "The integrator's own",
            text: integrator,
            offers: &[Offer {
                label: "dt = 0.1 s",
                act: |state| {
                    state.edit(Edit::new("dt", vec![Change::Dt(LONG)]));
                    state.send(Command::Pace(Pace::RealTime));
                    state.send(Command::Play(true));
                },
            }],
            done: |state, memory| state.report.params.dt >= 0.5 * LONG && memory.elapsed(state) >= 3.0,
            quiz: None,
        },
        LessonStep {
            title: "Which keep their energy?",
            text: |_, _| {
                "Each answer is a run of ten simulated seconds that the engine has just made.".to_owned()
            },
            offers: &[],
            done: |_, _| true,
            quiz: Some(quiz),
        },
    ],
};

fn show_plot(state: &mut AppState) {
    state.shown.plots = true;
    state.plot = PlotKind::Energy;
    state.send(Command::KeepLedger(true));
}

fn lost(state: &AppState, _: &Memory) -> String {
    let report = &state.report;
    let (total, sums) = (report.energy.total(), report.energy.sums);
    let mut text = format!(
        "Now the total is {} J less than at the start. The dashed line says where to: {} J were lost in the damper, which brakes the \
         spring's stretching and gets warm.",
        joules(sums.start + sums.work_in - total),
        joules(sums.lost_in_dampers)
    );
    if !report.ledger_is_whole {
        text.push_str(
            "\nThe two do not agree, as the books were opened late. Reset (R) and play once more to see all of it.",
        );
    }
    text
}

fn integrator(state: &AppState, _: &Memory) -> String {
    let error = state.report.energy.sums.integrator_error;
    format!(
        "Now take steps ten times as long, dt = 0.1 s, and look at the dotted line. It was almost flat; now it swings. The method \
         computes with forces that are a step old, so a little energy comes and goes that no force put there. It is {} J now. It \
         shrinks in proportion to dt, and it stays bounded: that is the merit of moving with the new velocity.",
        joules(error)
    )
}

fn joules(value: f64) -> String {
    if value.abs() < 5e-4 { "0".to_owned() } else { with_minus(format!("{value:.3}")) }
}

/// Runs of the mass on a spring, each judged by how much its total energy changes.
fn quiz() -> Result<Quiz> {
    const SECONDS: f64 = 10.0;
    /// Of the largest kinetic energy on the way.
    const ALLOWED: f64 = 0.02;
    let scene = Scene::builtin("spring")?;
    let tries: [(&str, f32, f64); 4] = [
        ("No damping, dt = 0.001 s", 0.0, 0.001),
        ("No damping, dt = 0.5 s", 0.0, 0.5),
        ("The spring's own damping, dt = 0.001 s", 1.0, 0.001),
        ("A tenth of that damping, dt = 0.001 s", 0.1, 0.001),
    ];
    let judge = |&(text, factor, dt): &(&str, f32, f64)| match keeps(&scene, factor, dt, SECONDS) {
        Some((change, swing)) => {
            let share = change / swing.max(f64::MIN_POSITIVE);
            let because = format!(
                "the total strays by up to {} J, {} % of the largest kinetic energy",
                joules(change),
                significant((1000.0 * share).round() / 10.0)
            );
            Answer::new(text, share < ALLOWED, because)
        }
        None => Answer::new(text, false, "this run blows up"),
    };
    let question =
        "Which of these runs keep their total energy within 2 % of the largest kinetic energy?".to_owned();
    Ok(Quiz { question, answers: tries.iter().map(judge).collect() })
}

/// The largest change of the total energy over a run, and the largest kinetic energy on the way, J; `None` if it blows up.
fn keeps(scene: &Scene, damping_factor: f32, dt: f64, seconds: f64) -> Option<(f64, f64)> {
    let mut run = scene.simulation().ok()?;
    let own = run.params().spring_damping.first().copied().unwrap_or_default();
    let all = 0..run.model().spring_count();
    run.change(Change::Dt(dt)).ok()?;
    run.change(Change::Damping(all, damping_factor * own)).ok()?;
    let start = run.energy().total();
    let (mut change, mut swing) = (0.0_f64, 0.0_f64);
    for _ in 0..(seconds / dt).ceil() as u32 {
        run.step(dt).ok()?;
        let energy = run.energy();
        change = change.max((energy.total() - start).abs());
        swing = swing.max(energy.kinetic);
    }
    Some((change, swing))
}
