//! The lesson about the longest stable step: make the jelly explode, understand why, and mend it.

use sprung::scene::Scene;
use sprung::{Change, Params, Result, significant, stability};
use sprung_driver::{Command, Edit, Pace};

use super::lesson::{Lesson, LessonStep, Memory, Offer};
use super::quiz::{Answer, Quiz};
use crate::action::Action;
use crate::plots::PlotKind;
use crate::state::{AppState, Pick};

/// A step that is 4 % too long for the jelly, s.
const TOO_LONG: f64 = 0.0125;

/// The lesson.
pub const LESSON: Lesson = Lesson {
    title: "Make it explode, now explain it",
    about: "Every simulation of springs explodes when its steps are too long. Here you do it on purpose, and find out which spring \
            began it, why, and what helps.",
    steps: &[
        LessonStep {
            title: "Watch the jelly",
            text: |_, _| {
                "Open the cube of jelly and let it fall for a second. It is a thousand points and 7,560 springs, moved on a hundred \
                 times a second: dt = 0.01 s."
                    .to_owned()
            },
            offers: &[Offer {
                label: "Open the jelly",
                act: |state| {
                    state.act(Action::Scene(2));
                    state.send(Command::Play(true));
                },
            }],
            done: |state, memory| state.report.opened.name == "jelly" && memory.elapsed(state) >= 1.0,
            quiz: None,
        },
        LessonStep {
            title: "Look at the stability meter",
            text: meter,
            offers: &[],
            done: |_, _| true,
            quiz: None,
        },
        LessonStep {
            title: "Step over the edge",
            text: |_, _| {
                "Now set dt to 0.0125 s, slow down to a tenth, and watch the energy plot. The cube still looks calm. Then some springs \
                 begin to tremble; energy comes from nowhere, doubles, and doubles again.\nWait until it blows up: the program \
                 notices, stops, and keeps the last good state."
                    .to_owned()
            },
            offers: &[Offer { label: "Do it, slowly, with the energy plot", act: step_over }],
            done: |_, memory| memory.blow_up.is_some(),
            quiz: None,
        },
        LessonStep {
            title: "Read what it says",
            text: card,
            offers: &[Offer { label: "Point out the spring", act: point_out }],
            done: |_, _| true,
            quiz: None,
        },
        LessonStep {
            title: "Why this spring, why this dt",
            text: why,
            offers: &[],
            done: |_, _| true,
            quiz: None,
        },
        LessonStep {
            title: "Mend it",
            text: |_, memory| {
                let when = memory.blow_up.as_ref().map_or(0.0, |blow_up| blow_up.time);
                format!(
                    "Three ways out: shorter steps; more steps in the same time; or springs that tremble more slowly, with less \
                     stiffness, less damping or more mass. Choose one. It goes back by two seconds, makes the change and goes on, \
                     past t = {when:.2} s, where it blew up."
                )
            },
            offers: &[
                Offer {
                    label: "Shorter steps: dt = 0.011 s",
                    act: |state| mend(state, "dt", |_| vec![Change::Dt(0.011)]),
                },
                Offer {
                    label: "Half of dt, twice the substeps",
                    act: |state| {
                        mend(state, "substeps", |params| {
                            vec![Change::Dt(0.5 * params.dt), Change::Substeps(2 * params.substeps)]
                        });
                    },
                },
                Offer {
                    label: "Half the damping, half the stiffness",
                    act: |state| {
                        mend(state, "softer springs", |params| {
                            let all = 0..params.spring_stiffness.len();
                            let [k, d] = [&params.spring_stiffness, &params.spring_damping]
                                .map(|values| values.first().copied().unwrap_or_default());
                            vec![Change::Stiffness(all.clone(), 0.5 * k), Change::Damping(all, 0.5 * d)]
                        });
                    },
                },
            ],
            done: |state, memory| {
                let report = &state.report;
                let stable = report.stability.certified.is_some_and(|limit| limit.dt > report.params.dt);
                let passed = memory.blow_up.as_ref().is_some_and(|blow_up| report.now.time > blow_up.time);
                report.trouble.is_none() && stable && passed
            },
            quiz: None,
        },
        LessonStep {
            title: "What would have helped?",
            text: |_, _| {
                "Try the answers: for each one the true limit is computed anew, for the cube as it stands at first.".to_owned()
            },
            offers: &[],
            done: |_, _| true,
            quiz: Some(quiz),
        },
    ],
};

fn meter(state: &AppState, memory: &Memory) -> String {
    let report = &state.report;
    let limit = report.stability.sharp.or_else(|| memory.own_limit.as_ref()?.dt);
    let Some(limit) = limit else { return "Nothing limits the step here: open the jelly first.".to_owned() };
    let (dt, share) = (report.params.dt, 100.0 * report.params.dt / limit);
    format!(
        "The meter beside dt says how much of the longest stable step is used. With dt = {} s and a limit of {} s that is now \
         {share:.0} %.\nWithin the limit every trembling of the cube dies away. Beyond it the fastest one grows with every step. \
         There is not much room: the report's jelly is one nudge of a slider away from the edge.",
        significant(dt),
        significant(limit)
    )
}

fn step_over(state: &mut AppState) {
    state.shown.plots = true;
    state.plot = PlotKind::Energy;
    state.send(Command::Dismiss);
    state.send(Command::AutoSubsteps(false));
    state.send(Command::Reset);
    state.edit(Edit::new("dt", vec![Change::Dt(TOO_LONG)]));
    state.send(Command::Pace(Pace::Slow(10.0)));
    state.send(Command::Play(true));
}

fn card(_: &AppState, memory: &Memory) -> String {
    let Some(blow_up) = &memory.blow_up else {
        return "Nothing has blown up yet. Go back a step to make it.".to_owned();
    };
    let place = match (blow_up.spring, &blow_up.points[..]) {
        (Some(spring), &[i, j]) => {
            format!(
                "The tightest place is spring {spring} of {}, between points {i} and {j}.",
                blow_up.owner.replace('_', " ")
            )
        }
        (_, &[point]) => format!("The tightest place is point {point}, at the ground or under your hand."),
        _ => String::new(),
    };
    format!(
        "At t = {:.2} s, step {}, it was over: more than half of all energy of motion and springs had come from nowhere. You see the \
         last good state, of t = {:.2} s.\n{place}\nLook at the line \"lost in dampers\" in the plot: it has gone \
         below zero. Dampers whose steps are too long do not take energy, they give it.",
        blow_up.time, blow_up.step, blow_up.good_time
    )
}

fn point_out(state: &mut AppState) {
    let Some(limit) = state.report.stability.certified else { return };
    let pick = Pick::from(limit.setter);
    state.pointed_out = vec![pick];
    state.selection = Some(pick);
}

/// The formula with the numbers of the spring that blew up: alone, and among its neighbours.
fn why(state: &AppState, memory: &Memory) -> String {
    let report = &state.report;
    let (model, params) = (&report.opened.model, &report.opened.params);
    let spring = memory.blow_up.as_ref().and_then(|blow_up| blow_up.spring).unwrap_or(0);
    let (Some(ends), Some(all)) = (model.springs().get(spring), memory.own_limit.as_ref()) else {
        return "Open the jelly, and make it blow up first.".to_owned();
    };
    let per_mass: f64 = ends.iter().map(|end| f64::from(params.inverse_mass(*end as usize))).sum();
    let omega2 = f64::from(params.spring_stiffness[spring]) * per_mass;
    let c = f64::from(params.spring_damping[spring]) * per_mass;
    let neighbours = ends.map(|end| model.springs_at(end as usize).len());
    let limit = |omega2: f64, c: f64| significant(4.0 / (c + (c * c + 4.0 * omega2).sqrt()));
    format!(
        "A trembling with ω² and damping c (per mass) stays bounded while dt < 4/(c + √(c² + 4ω²)).\nSpring {spring} alone has ω² = \
         {} 1/s² and c = {} 1/s, and would bear dt = {} s. But its points have {} and {} springs, and when neighbours tremble \
         against each other all of these pull at once: together ω² = {} 1/s² and c = {} 1/s. So the limit is {} s, and {} s is \
         over it.\nThe damper does not help. It brakes by the speed at the start of the step; if the step is long, it brakes so \
         hard that it throws the point back.",
        significant(omega2),
        significant(c),
        limit(omega2, c),
        neighbours[0],
        neighbours[1],
        significant(all.omega2_max),
        significant(all.c_max),
        limit(all.omega2_max, all.c_max),
        significant(TOO_LONG),
    )
}

fn mend(state: &mut AppState, label: &str, changes: impl Fn(&Params) -> Vec<Change>) {
    let changes = changes(&state.report.params);
    state.edit(Edit::new(label, changes));
    state.send(Command::Pace(Pace::RealTime));
    state.send(Command::RewindAndGoOn(2.0));
}

/// Changes to the jelly at dt = 0.0125 s, each judged by its true limit.
fn quiz() -> Result<Quiz> {
    let (model, own, first_state) = Scene::builtin("jelly")?.build()?;
    let first = |values: &[f32]| values.first().copied().unwrap_or_default();
    let (springs, points) = (0..model.spring_count(), 0..model.point_count());
    let (k, d, m) = (first(&own.spring_stiffness), first(&own.spring_damping), first(&own.point_mass));
    let tries: [(&str, Change); 6] = [
        ("Halve the stiffness of all springs", Change::Stiffness(springs.clone(), 0.5 * k)),
        ("Double the damping", Change::Damping(springs.clone(), 2.0 * d)),
        ("Take all damping away", Change::Damping(springs, 0.0)),
        ("Double every mass", Change::Mass(points, 2.0 * m)),
        ("Switch gravity off", Change::Gravity(sprung::Vec3::ZERO)),
        ("Twice the substeps, with the same dt", Change::Substeps(own.substeps.saturating_mul(2))),
    ];
    let judge = |(text, change): &(&str, Change)| {
        let mut params = own.clone();
        params.dt = TOO_LONG;
        if let Err(error) = params.apply(&model, change) {
            return Answer::new(*text, false, error.to_string());
        }
        let Some(limit) = stability::sharp(&model, &params, &first_state.position).dt else {
            return Answer::new(*text, true, "then nothing limits dt");
        };
        let relation = if TOO_LONG < limit { "below" } else { "above" };
        let because =
            format!("the limit is then {} s, and dt = {TOO_LONG} s is {relation} it", significant(limit));
        Answer::new(*text, TOO_LONG < limit, because)
    };
    let question = format!(
        "With dt = {TOO_LONG} s and all else as at first: which single changes make the cube stable?"
    );
    Ok(Quiz { question, answers: tries.iter().map(judge).collect() })
}
