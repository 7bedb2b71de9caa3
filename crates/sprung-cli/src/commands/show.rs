//! `sprung show`: what a scene is, and how large dt may be.

use serde::Serialize;
use sprung::scene::Scene;
use sprung::stability::{self, Limit, Sharp};
use sprung::{Energy, Result, Simulation, significant as rounded};
use sprung_io::checkpoint::Recording;

use super::checkpoints::recorded_of;
use super::limits::{Contacts, describe, remedy};
use crate::args::ShowArgs;
use crate::console::{counted, grouped, say};
use crate::source::{self, Begun};

/// The answer to `show --json`. A limit that does not exist is `null`.
#[derive(Serialize)]
struct Answer {
    scene: String,
    title: String,
    points: usize,
    springs: usize,
    pinned: usize,
    bodies: Vec<String>,
    /// m; along x, y and z, from the outermost points.
    size: [f64; 3],
    /// What became of each mesh.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    meshes: Vec<OfMesh>,
    /// s.
    dt: f64,
    /// Steps from one frame to the next.
    substeps: u64,
    /// s; simulated time from one frame to the next.
    frame_time: f64,
    /// s.
    dt_limit: Option<f64>,
    /// s.
    dt_limit_certified: Option<f64>,
    dt_limit_certified_set_by: Option<String>,
    /// s.
    dt_limit_every_configuration: Option<f64>,
    dt_limit_every_configuration_set_by: Option<String>,
    /// 1/s².
    omega2_max: f64,
    /// 1/s.
    c_max: f64,
    /// kg.
    total_mass: f64,
    /// J; the sum of the parts.
    energy: f64,
    energy_parts: EnergyParts,
    state_hash: String,
    /// Where it is a checkpoint that is described.
    #[serde(skip_serializing_if = "Option::is_none")]
    checkpoint: Option<OfCheckpoint>,
}

/// A body made from a mesh.
#[derive(Serialize)]
struct OfMesh {
    body: String,
    file: String,
    /// cloth, soft or net.
    becomes: &'static str,
    points: usize,
    springs: usize,
}

/// What a checkpoint holds besides a scene that is under way.
#[derive(Serialize)]
struct OfCheckpoint {
    /// The version of the program that wrote it.
    program: String,
    step: u64,
    /// s.
    time: f64,
    /// Of the recording that it is of, if it is of one.
    recording: Option<OfRecording>,
}

#[derive(Serialize)]
struct OfRecording {
    recorded_frames: u64,
    last_frame: u64,
    /// Why no frame is to follow, once that is so; empty at the end of the run.
    ended: Option<String>,
    folder: String,
    outputs: Vec<String>,
    plot: Option<String>,
}

#[derive(Serialize)]
struct EnergyParts {
    kinetic: f64,
    gravitational: f64,
    elastic: f64,
    contact: f64,
}

/// Prints the description.
pub fn run(args: &ShowArgs) -> Result<()> {
    let (begun, checkpoint) = begun(args)?;
    let Begun { name, scene, mut simulation, steps_per_frame } = begun;
    let energy = simulation.energy();
    let (model, params, positions) = (simulation.model(), simulation.params(), &simulation.state().position);
    // Of a large scene each takes about a second; so both at once.
    let (sharp, certified) = std::thread::scope(|scope| {
        let certified = scope.spawn(|| stability::certified(model, params, positions));
        (stability::sharp(model, params, positions), certified.join())
    });
    let certified = certified.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    let every = stability::every_configuration(model, params);
    if args.json {
        let answer = Answer {
            scene: name,
            title: scene.title.clone(),
            points: model.point_count(),
            springs: model.spring_count(),
            pinned: fixed_points(&simulation),
            bodies: model.bodies().iter().map(|body| body.name.clone()).collect(),
            size: size(&simulation),
            meshes: meshes(&scene, &simulation),
            dt: params.dt,
            substeps: steps_per_frame,
            frame_time: params.dt * steps_per_frame as f64,
            dt_limit: sharp.dt,
            dt_limit_certified: certified.map(|limit| limit.dt),
            dt_limit_certified_set_by: certified.map(|limit| describe(&simulation, &limit, Contacts::Now)),
            dt_limit_every_configuration: every.map(|limit| limit.dt),
            dt_limit_every_configuration_set_by: every
                .map(|limit| describe(&simulation, &limit, Contacts::Ever)),
            omega2_max: sharp.omega2_max,
            c_max: sharp.c_max,
            total_mass: total_mass(&simulation),
            energy: energy.total(),
            energy_parts: EnergyParts {
                kinetic: energy.kinetic,
                gravitational: energy.gravitational,
                elastic: energy.elastic,
                contact: energy.contact,
            },
            state_hash: format!("{:016x}", simulation.state_hash()),
            checkpoint,
        };
        say(serde_json::to_string_pretty(&answer).unwrap_or_default());
    } else {
        say(if scene.title.is_empty() { name } else { format!("{name}: {}", scene.title) });
        if let Some(checkpoint) = &checkpoint {
            print_checkpoint(checkpoint);
        }
        print(&scene, &simulation, steps_per_frame, &energy, &sharp, certified.as_ref(), every.as_ref());
    }
    Ok(())
}

/// What is to be described: a scene at its start, or what a checkpoint holds.
fn begun(args: &ShowArgs) -> Result<(Begun, Option<OfCheckpoint>)> {
    if !source::is_checkpoint(&args.scene.scene) {
        return Ok((source::begun(&args.scene, Some(1))?, None));
    }
    let (path, saved) = source::saved(&args.scene)?;
    let begun = source::begun_from(path, &saved, Some(1))?;
    let recording = saved.recording.map(|Recording { plan, .. }| OfRecording {
        recorded_frames: plan.recorded,
        last_frame: plan.last_frame,
        ended: plan.ended,
        folder: plan.folder,
        outputs: plan.outputs,
        plot: plan.plot,
    });
    let state = &saved.checkpoint.state;
    let (program, step, time) = (saved.program, state.step, state.time);
    Ok((begun, Some(OfCheckpoint { program, step, time, recording })))
}

fn print_checkpoint(checkpoint: &OfCheckpoint) {
    let OfCheckpoint { program, step, time, recording } = checkpoint;
    row("checkpoint", format!("step {}, t = {} s, by sprung {program}", grouped(*step), rounded(*time)));
    let Some(recording) = recording else { return };
    let frames = recorded_of(recording.recorded_frames, recording.last_frame);
    row(
        "recorded",
        match recording.ended.as_deref() {
            None => frames,
            Some("") => format!("{frames}; the run is over"),
            Some(reason) => format!("{frames}; the run had ended: {reason}"),
        },
    );
    let outputs = recording.outputs.iter().chain(&recording.plot);
    for (number, output) in outputs.enumerate() {
        row(if number == 0 { "outputs" } else { "" }, output.clone());
    }
    row("begun in", recording.folder.clone());
}

fn row(label: &str, text: String) {
    say(format_args!("  {label:<20} {text}"));
}

fn print(
    scene: &Scene,
    simulation: &Simulation,
    steps_per_frame: u64,
    energy: &Energy,
    sharp: &Sharp,
    certified: Option<&Limit>,
    every: Option<&Limit>,
) {
    let (model, params) = (simulation.model(), simulation.params());
    let fixed = fixed_points(simulation);
    row("points", format!("{}, of which {} fixed", grouped(model.point_count()), grouped(fixed)));
    row("springs", grouped(model.spring_count()));
    row("size", format!("{} m", size(simulation).map(rounded).join(" × ")));
    for OfMesh { body, file, becomes, points, springs } in meshes(scene, simulation) {
        let kind = if becomes == "soft" { "soft body" } else { becomes };
        let (points, springs) = (counted(points as u64, "point"), counted(springs as u64, "spring"));
        row("mesh", format!("{file} as {kind} {body}: {points}, {springs}"));
    }
    row("moving mass", format!("{} kg", rounded(total_mass(simulation))));
    row("energy", format!("{} J", rounded(energy.total())));
    let frame = rounded(params.dt * steps_per_frame as f64);
    let substeps = counted(steps_per_frame, "substep");
    row("dt", format!("{} s × {substeps} = {frame} s per frame", rounded(params.dt)));
    match sharp.dt {
        None => row("dt limit", "none: nothing here limits the step".to_owned()),
        Some(limit) => {
            let verdict = if params.dt > limit { "  TOO LARGE: expect a blow-up" } else { "" };
            row("dt limit", share(params.dt, limit) + verdict);
        }
    }
    if let Some(limit) = certified {
        row(
            "  certified",
            format!("{}, set by {}", share(params.dt, limit.dt), describe(simulation, limit, Contacts::Now)),
        );
    }
    if let Some(limit) = every {
        row(
            "  in any shape",
            format!("{}, set by {}", share(params.dt, limit.dt), describe(simulation, limit, Contacts::Ever)),
        );
    }
    let limits = [(every, Contacts::Ever), (certified, Contacts::Now)];
    if let Some(text) =
        limits.into_iter().find_map(|(limit, contacts)| remedy(simulation, scene, limit?, contacts))
    {
        row("for longer steps", text);
    }
    if sharp.dt.is_some() {
        row(
            "fastest vibration",
            format!("ω² = {} 1/s², damping c = {} 1/s", rounded(sharp.omega2_max), rounded(sharp.c_max)),
        );
    }
    row("state hash", format!("{:016x}", simulation.state_hash()));
}

fn share(dt: f64, limit: f64) -> String {
    format!("{} s; dt is {:.1} % of it", rounded(limit), 100.0 * dt / limit)
}

/// From the outermost points, m.
fn size(simulation: &Simulation) -> [f64; 3] {
    let places = simulation.state().position.iter().map(|place| place.as_dvec3());
    let around = places.map(|place| [place; 2]).reduce(|[low, high], [p, _]| [low.min(p), high.max(p)]);
    around.map_or([0.0; 3], |[low, high]| (high - low).to_array())
}

/// What became of each mesh.
fn meshes(scene: &Scene, simulation: &Simulation) -> Vec<OfMesh> {
    let bodies = scene.bodies.iter().zip(simulation.model().bodies());
    let from_mesh = bodies.filter_map(|(said, made)| Some((said, said.mesh.as_ref()?, made)));
    from_mesh
        .map(|(said, mesh, made)| OfMesh {
            body: said.name.clone(),
            file: mesh.file.clone(),
            becomes: match (&said.cloth, &said.soft) {
                (Some(_), _) => "cloth",
                (None, Some(_)) => "soft",
                (None, None) => "net",
            },
            points: made.points.len(),
            springs: made.springs.len(),
        })
        .collect()
}

fn fixed_points(simulation: &Simulation) -> usize {
    (0..simulation.model().point_count()).filter(|&point| simulation.params().is_fixed(point)).count()
}

/// Of the points that can move, kg: a fixed point has no mass as far as the motion goes.
fn total_mass(simulation: &Simulation) -> f64 {
    let (params, points) = (simulation.params(), simulation.model().point_count());
    let free = (0..points).filter(|&point| !params.is_fixed(point));
    // Not `sum`, which makes -0 of nothing.
    free.fold(0.0, |sum, point| sum + f64::from(params.point_mass[point]))
}
