//! Undo and redo against a model that keeps every state of the parameters.

mod common;

use std::sync::Arc;

use common::{check, edit, open};
use proptest::prelude::*;
use sprung::{Change, Params, Vec3};
use sprung_driver::{Command, Edit};

/// What a user does.
#[derive(Clone, Debug)]
enum Act {
    Edit(&'static str, Change, bool),
    Undo,
    Redo,
    Step,
    Reset,
    Auto(bool),
}

fn act() -> impl Strategy<Value = Act> {
    let change = prop_oneof![
        (-20.0f32..20.0).prop_map(|g| ("gravity", Change::Gravity(Vec3::new(0.0, g, 0.0)))),
        (1.0f32..300.0).prop_map(|k| ("stiffness", Change::Stiffness(0..14, k))),
        (0usize..15, any::<bool>()).prop_map(|(point, on)| ("pin", Change::Pin(point..point + 1, on))),
        (0usize..14, any::<bool>()).prop_map(|(spring, on)| ("cut", Change::Cut(spring..spring + 1, on))),
        (0usize..15, 0.5f32..5.0).prop_map(|(point, mass)| ("mass", Change::Mass(point..point + 1, mass))),
    ];
    prop_oneof![
        6 => (change, any::<bool>()).prop_map(|((label, change), continues)| Act::Edit(label, change, continues)),
        4 => Just(Act::Undo),
        3 => Just(Act::Redo),
        2 => Just(Act::Step),
        1 => Just(Act::Reset),
        1 => any::<bool>().prop_map(Act::Auto),
    ]
}

type Setting = (Arc<Params>, bool);

proptest! {
    #![proptest_config(common::cases(300))]

    #[test]
    fn undo_and_redo_walk_through_the_settings(acts in prop::collection::vec(act(), 1..60)) {
        let mut handle = open("chain");
        let setting = |handle: &mut sprung_driver::Handle| -> Setting {
            let report = handle.report();
            (report.params.clone(), report.auto_substeps)
        };
        // Labels and settings, and where among them we are.
        let mut settings: Vec<(&'static str, Setting)> = vec![("", setting(&mut handle))];
        let mut here = 0usize;
        let mut is_open = false;
        for act in acts {
            let label = match &act {
                Act::Edit(label, ..) => label,
                Act::Auto(true) => "auto sub-steps on",
                Act::Auto(false) => "auto sub-steps off",
                _ => "",
            };
            match act.clone() {
                Act::Edit(label, change, continues) => {
                    handle.send(Command::Edit(Edit { continues, ..Edit::new(label, vec![change]) }));
                }
                Act::Auto(on) => handle.send(Command::AutoSubsteps(on)),
                Act::Undo => {
                    handle.send(Command::Undo);
                    (here, is_open) = (here.saturating_sub(1), is_open && here == 0);
                }
                Act::Redo => {
                    handle.send(Command::Redo);
                    is_open = is_open && here + 1 == settings.len();
                    here = (here + 1).min(settings.len() - 1);
                }
                Act::Step => handle.send(Command::Step),
                Act::Reset => handle.send(Command::Reset),
            }
            if matches!(act, Act::Edit(..) | Act::Auto(_)) {
                let new = setting(&mut handle);
                if new != settings[here].1 {
                    let continues = matches!(act, Act::Edit(.., true));
                    settings.truncate(here + 1);
                    if continues && is_open && settings[here].0 == label {
                        settings[here].1 = new;
                        is_open = settings[here].1 != settings[here - 1].1;
                        if !is_open {
                            settings.truncate(here);
                            here -= 1;
                        }
                    } else {
                        settings.push((label, new));
                        here += 1;
                        is_open = true;
                    }
                }
            }
            let report = handle.report();
            check(&report);
            prop_assert!(report.trouble.is_none(), "{:?}", report.trouble);
            prop_assert_eq!(&setting(&mut handle), &settings[here].1);
            prop_assert_eq!(report.undo.as_deref(), (here > 0).then(|| settings[here].0));
            prop_assert_eq!(report.redo.as_deref(), settings.get(here + 1).map(|next| next.0));
        }
    }
}

#[test]
fn a_slider_that_is_dragged_is_one_edit() {
    let mut handle = open("chain");
    handle.send(Command::Play(true));
    for value in 0..50u8 {
        let change = Change::Gravity(Vec3::Y * -f32::from(value));
        handle.send(Command::Edit(Edit { continues: value > 0, ..Edit::new("gravity", vec![change]) }));
        handle.pass(1.0 / 60.0);
    }
    let report = handle.report();
    assert!(report.timeline.marks.len() <= 2, "{:?}", report.timeline.marks);
    handle.send(Command::Undo);
    let report = handle.report();
    assert_eq!(
        (report.params.gravity.y, report.undo.clone(), report.redo.as_deref()),
        (-9.81, None, Some("gravity"))
    );
    handle.send(Command::Redo);
    assert_eq!(handle.report().params.gravity.y, -49.0);
    handle.send(Command::Open(Box::new(common::source("spring"))));
    let report = handle.report();
    assert!(report.undo.is_none() && report.redo.is_none());
}

/// Nine megabytes for each value of a slider would soon be too many.
#[test]
fn a_slider_that_is_dragged_while_a_large_scene_plays_takes_little_memory() {
    let mut handle = open("cloth");
    let model = handle.report().opened.model.clone();
    handle.send(Command::Play(true));
    let before = handle.report().timeline.bytes.0;
    let edits = 60u8;
    for value in 0..edits {
        let change = Change::Stiffness(0..model.spring_count(), 300.0 + f32::from(value));
        handle.send(Command::Edit(Edit { continues: value > 0, ..Edit::new("stiffness", vec![change]) }));
        handle.pass(1.0 / 60.0);
    }
    let report = handle.report();
    // Checkpoints with a stiffness of their own, and an entry of the log for each edit.
    let checkpoints = 1 + report.now.step as usize / 64;
    let most = checkpoints * (48 * model.point_count() + 4 * model.spring_count()) + usize::from(edits) * 256;
    let taken = report.timeline.bytes.0 - before;
    assert!(taken <= most, "{taken} bytes for {edits} edits, and {most} are enough");
    handle.send(Command::Undo);
    assert_eq!(handle.report().params, handle.report().opened.params);
}

#[test]
fn a_slider_that_is_dragged_away_and_back_leaves_nothing_to_undo() {
    let mut handle = open("chain");
    let drag = |handle: &mut sprung_driver::Handle, values: &[f32]| {
        for (index, &value) in values.iter().enumerate() {
            let change = Change::Gravity(Vec3::Y * value);
            handle.send(Command::Edit(Edit { continues: index > 0, ..Edit::new("gravity", vec![change]) }));
        }
    };
    drag(&mut handle, &[-5.0, -3.0]);
    drag(&mut handle, &[-2.0, -3.0]);
    assert_eq!(handle.report().undo.as_deref(), Some("gravity"));
    // Back where it began and on again: one more edit, not the first one's continuation.
    drag(&mut handle, &[-2.0, -3.0, -1.0]);
    for expected in [-3.0, -9.81] {
        handle.send(Command::Undo);
        assert_eq!(handle.report().params.gravity.y, expected);
    }
    assert_eq!(handle.report().undo, None);
}

#[test]
fn an_edit_that_changes_nothing_leaves_redo_alone() {
    let mut handle = open("chain");
    handle.send(edit("gravity", Change::Gravity(Vec3::ZERO)));
    handle.send(Command::Undo);
    handle.send(edit("pin", Change::Pin(0..1, true)));
    handle.send(edit("pin", Change::Pin(0..1, true)));
    assert_eq!(handle.report().redo.as_deref(), handle.report().undo.is_none().then_some("gravity"));
}
