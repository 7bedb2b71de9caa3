//! Commands.

use crate::command::{Command, Edit, Fix, Pace, Probe, Pull};

use super::{enums, structs};

structs! {
    Edit { label, changes, continues }
    Pull { point, target, hard }
}

enums! {
    Fix { 0 Dt(dt), 1 Substeps, 2 Damping(factor) }
    Pace { 0 RealTime, 1 Frames, 2 Slow(times) }
    Probe {
        0 Position(point, axis),
        1 Velocity(point, axis),
        2 Speed(point),
        3 Length(spring),
        4 Strain(spring),
        5 Tension(spring),
        6 Energy(spring),
        7 Force(point, axis),
    }
    Command {
        0 Open(source),
        1 GoOn(kept),
        2 Checkpoint(on),
        3 Play(on),
        4 Step,
        5 Frame,
        6 Reset,
        7 OwnValues,
        8 Edit(edit),
        9 Undo,
        10 Redo,
        11 Seek(step),
        12 Pace(pace),
        13 AutoSubsteps(on),
        14 Pull(pull),
        15 Release,
        16 Settle,
        17 FindSharpLimit,
        18 KeepLedger(on),
        19 WantForces(on),
        20 Watch(probes),
        21 Compare(on),
        22 Fix(fix),
        23 RewindAndGoOn(seconds),
        24 Dismiss,
    }
}
