//! What is large: snapshots, forces, parameters, checkpoints. Each as it lies in memory, and only if it is new.

use std::sync::Arc;

use sprung::{Checkpoint, Model, Params, Result, Snapshot, State, Vec3};
use sprung_io::{Pack, Unpack};

use super::shared::{never, read_known, write_known};
use super::{Wire, damaged};

pub(super) fn write_snapshot(pack: &mut Pack, snapshot: &Arc<Snapshot>, known: &[&Arc<Snapshot>]) {
    if write_known(pack, snapshot, known, is_same) {
        pack.snapshot(snapshot);
    }
}

pub(super) fn read_snapshot(
    read: &mut Unpack<'_>,
    known: &[&Arc<Snapshot>],
    model: &Model,
) -> Result<Arc<Snapshot>> {
    let snapshot = read_known(read, known, Unpack::snapshot)?;
    check_length(&snapshot.positions, model)?;
    check_length(&snapshot.velocities, model)?;
    Ok(snapshot)
}

/// To the bit. Most that are not the same differ in their first point: what is copied is looked at once.
fn is_same(a: &Snapshot, b: &Snapshot) -> bool {
    fn bits(vectors: &[Vec3]) -> &[u32] {
        bytemuck::cast_slice(vectors)
    }
    (a.step, a.time.to_bits()) == (b.step, b.time.to_bits())
        && bits(&a.positions) == bits(&b.positions)
        && bits(&a.velocities) == bits(&b.velocities)
}

pub(super) fn check_length<T>(values: &[T], model: &Model) -> Result<()> {
    if values.len() == model.point_count() { Ok(()) } else { Err(unfit()) }
}

fn unfit() -> sprung::Error {
    damaged("does not fit the model")
}

/// Parameters, of which each long array is sent only if it is none of a known one.
pub(super) fn write_params(pack: &mut Pack, params: &Arc<Params>, known: &[&Arc<Params>]) {
    if !write_known(pack, params, known, never) {
        return;
    }
    pack.short_params(params);
    let mut numbers = |of: fn(&Params) -> &Arc<Vec<f32>>| {
        let known: Vec<_> = known.iter().map(|known| of(known)).collect();
        if write_known(pack, of(params), &known, never) {
            pack.f32s(of(params));
        }
    };
    numbers(|params| &params.point_mass);
    numbers(|params| &params.spring_stiffness);
    numbers(|params| &params.spring_damping);
    numbers(|params| &params.spring_rest_length);
    let mut answers = |of: fn(&Params) -> &Arc<Vec<bool>>| {
        let known: Vec<_> = known.iter().map(|known| of(known)).collect();
        if write_known(pack, of(params), &known, never) {
            pack.bools(of(params));
        }
    };
    answers(|params| &params.point_pinned);
    answers(|params| &params.spring_cut);
}

pub(super) fn read_params(
    read: &mut Unpack<'_>,
    known: &[&Arc<Params>],
    model: &Model,
) -> Result<Arc<Params>> {
    read_known(read, known, |read| {
        let mut params = read.short_params()?;
        let mut numbers = |of: fn(&Params) -> &Arc<Vec<f32>>, count: usize| {
            let known: Vec<_> = known.iter().map(|known| of(known)).collect();
            let numbers = read_known(read, &known, Unpack::f32s)?;
            if numbers.len() == count { Ok(numbers) } else { Err(unfit()) }
        };
        params.point_mass = numbers(|params| &params.point_mass, model.point_count())?;
        params.spring_stiffness = numbers(|params| &params.spring_stiffness, model.spring_count())?;
        params.spring_damping = numbers(|params| &params.spring_damping, model.spring_count())?;
        params.spring_rest_length = numbers(|params| &params.spring_rest_length, model.spring_count())?;
        let mut answers = |of: fn(&Params) -> &Arc<Vec<bool>>, count: usize| {
            let known: Vec<_> = known.iter().map(|known| of(known)).collect();
            let answers = read_known(read, &known, Unpack::bools)?;
            if answers.len() == count { Ok(answers) } else { Err(unfit()) }
        };
        params.point_pinned = answers(|params| &params.point_pinned, model.point_count())?;
        params.spring_cut = answers(|params| &params.spring_cut, model.spring_count())?;
        let points = params.external_forces.keys().chain(params.carried.keys()).copied();
        let mut points = points.chain(params.grabs.iter().map(|grab| grab.point));
        if points.all(|point| point < model.point_count()) { Ok(params) } else { Err(unfit()) }
    })
}

pub(super) fn write_checkpoint(pack: &mut Pack, checkpoint: &Checkpoint, known: &[&Arc<Params>]) {
    let Checkpoint { state, params, keeps_ledger } = checkpoint;
    keeps_ledger.write(pack);
    write_params(pack, params, known);
    (state.step, state.time).write(pack);
    state.clock().write(pack);
    state.ledger.write(pack);
    pack.vec3s(&state.position).vec3s(&state.velocity);
    pack.vec3s(&state.position_low).vec3s(&state.velocity_low);
}

pub(super) fn read_checkpoint(
    read: &mut Unpack<'_>,
    known: &[&Arc<Params>],
    model: &Model,
) -> Result<Checkpoint> {
    let keeps_ledger = bool::read(read)?;
    let params = read_params(read, known, model)?;
    let (step, time) = Wire::read(read)?;
    let clock = Wire::read(read)?;
    let ledger = Wire::read(read)?;
    let mut state = State::new(read.vec3s()?, read.vec3s()?);
    (state.step, state.time, state.ledger) = (step, time, ledger);
    state.set_clock(clock);
    (state.position_low, state.velocity_low) = (read.vec3s()?, read.vec3s()?);
    for vectors in [&state.position, &state.velocity, &state.position_low, &state.velocity_low] {
        check_length(vectors, model)?;
    }
    Ok(Checkpoint { state, params, keeps_ledger })
}
