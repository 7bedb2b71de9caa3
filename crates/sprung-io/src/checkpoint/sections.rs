//! What the sections of version 1 hold, in their order:
//!
//! | section | content |
//! |---|---|
//! | `about` | version of the program (text), name of the scene (text), fingerprint of the model (u64), hash of the state (u64), whether the ledger is kept (u8) |
//! | `scene` | the scene as TOML, UTF-8 |
//! | `clock` | step (u64), time (f64), step (u64) and time (f64) since which dt has not changed, the ledger's sums (5 f64), steps suspect (u64) |
//! | `positions`, `positions-low`, `velocities`, `velocities-low` | a count (u64), and x, y, z (f32) of each point |
//! | `parameters` | dt, substeps, gravity, planes, forces, carried points, grabs |
//! | `masses`, `stiffness`, `damping`, `rest-lengths` | a count (u64), and so many f32 |
//! | `pins`, `cuts` | a count (u64), and so many bytes, 0 or 1 |
//! | `meshes` | a count (u64), and for each mesh that bodies of the scene are made from: the name of its file as the scene has it (text); coordinates of its vertices (f64s); the numbers of corners of its faces (u32s), their corners (u32s); the ends of its lines and the corners of its tetrahedra (u32s); a count (u64) of groups, each with a name (text) and vertices (u32s); red, green and blue of each vertex, or nothing (f32s); a count (u64) of warnings, each a text |
//! | `run` | what the recording is to do, as JSON; there only if there is one |
//! | `outputs` | a count (u64), and for each output: frames (u64), a count (u64) of files, each with part (text), length (u64), head (u64), CRC-32 (u32); what else the format remembers (bytes) |
//!
//! A text is its length in bytes (u64) and UTF-8; bytes are a length (u64) and the bytes; f64s, f32s and u32s are a count (u64)
//! and the numbers.

use std::collections::BTreeMap;
use std::io::{self, Read, Write};
use std::sync::Arc;

use sprung::energy::LedgerSums;
use sprung::{Checkpoint, Code, Error, Params, Result, State};

use super::container::{Sections, damaged, write_header, write_section};
use super::{Plan, Recording, Saved, VERSION};
use crate::export::{FileMark, Mark};
use crate::pack::{Pack, Unpack};

/// Sections of a simulation, and those that a recording adds.
const NAMES: [&str; 15] = [
    "about",
    "scene",
    "clock",
    "positions",
    "positions-low",
    "velocities",
    "velocities-low",
    "parameters",
    "masses",
    "pins",
    "stiffness",
    "damping",
    "rest-lengths",
    "cuts",
    "meshes",
];
const OF_RECORDINGS: [&str; 2] = ["run", "outputs"];

pub fn write(saved: &Saved, out: &mut impl Write) -> io::Result<()> {
    let Checkpoint { state, params, keeps_ledger } = &saved.checkpoint;
    let more = if saved.recording.is_some() { OF_RECORDINGS.len() } else { 0 };
    write_header(out, VERSION, (NAMES.len() + more) as u32)?;
    for name in NAMES {
        let mut pack = Pack::new();
        match name {
            "about" => {
                pack.text(&saved.program).text(&saved.scene_name).u64(saved.fingerprint).u64(state.hash());
                pack.u8((*keeps_ledger).into())
            }
            "scene" => {
                write_section(out, name, saved.scene.as_bytes())?;
                continue;
            }
            "clock" => clock(&mut pack, state),
            "positions" => pack.vec3s(&state.position),
            "positions-low" => pack.vec3s(&state.position_low),
            "velocities" => pack.vec3s(&state.velocity),
            "velocities-low" => pack.vec3s(&state.velocity_low),
            "parameters" => pack.short_params(params),
            "masses" => pack.f32s(&params.point_mass),
            "pins" => pack.bools(&params.point_pinned),
            "stiffness" => pack.f32s(&params.spring_stiffness),
            "damping" => pack.f32s(&params.spring_damping),
            "rest-lengths" => pack.f32s(&params.spring_rest_length),
            "cuts" => pack.bools(&params.spring_cut),
            _ => pack.meshes(&saved.meshes),
        };
        write_section(out, name, &pack.into_bytes())?;
    }
    let Some(recording) = &saved.recording else { return Ok(()) };
    write_section(out, "run", &serde_json::to_vec(&recording.plan)?)?;
    write_section(out, "outputs", &marks(&recording.marks))
}

fn clock<'a>(pack: &'a mut Pack, state: &State) -> &'a mut Pack {
    let LedgerSums { start, work_in, lost_in_dampers, lost_in_contact, integrator_error, suspect_steps } =
        state.ledger;
    let (step, time) = state.clock();
    pack.u64(state.step).f64(state.time).u64(step).f64(time);
    pack.f64(start).f64(work_in).f64(lost_in_dampers).f64(lost_in_contact).f64(integrator_error);
    pack.u64(suspect_steps)
}

fn marks(marks: &[Mark]) -> Vec<u8> {
    let mut pack = Pack::new();
    pack.u64(marks.len() as u64);
    for Mark { frames, files, memory } in marks {
        pack.u64(*frames).u64(files.len() as u64);
        for FileMark { part, bytes, head, crc32 } in files {
            pack.text(part).u64(*bytes).u64(*head).u32(*crc32);
        }
        pack.bytes(memory);
    }
    pack.into_bytes()
}

pub fn read(file: &mut impl Read, bytes: u64) -> Result<Saved> {
    let mut sections = Sections::open(file, bytes)?;
    match sections.version {
        VERSION => {}
        0 => return Err(damaged("it has no version of the format")),
        found => {
            let sentence = format!(
                "is in version {found} of the format, and this program knows version {VERSION}: a newer one wrote it"
            );
            return Err(Error::new(Code::Unsupported, sentence).with_fix("use the newest sprung"));
        }
    }
    // Read one after another, and their bytes let go: both at once would be twice the memory.
    let mut saved = Saved {
        program: String::new(),
        scene_name: String::new(),
        scene: String::new(),
        meshes: Vec::new(),
        fingerprint: 0,
        checkpoint: Checkpoint {
            state: State::new(Vec::new(), Vec::new()),
            params: Arc::new(Unpack::new(&NO_PARAMETERS).short_params()?),
            keeps_ledger: false,
        },
        recording: None,
    };
    let mut hash = 0;
    // How often each section came: once is right.
    let mut came = BTreeMap::<&str, u32>::new();
    while let Some((name, content)) = sections.next()? {
        let Some(known) = NAMES.iter().chain(&OF_RECORDINGS).find(|known| **known == name) else {
            return Err(damaged(&format!("there is no section `{name}` in version {VERSION}")));
        };
        *came.entry(known).or_default() += 1;
        read_section(&mut saved, &mut hash, known, &content)
            .map_err(|error| damaged(&format!("the section `{known}` {}", error.sentence())))?;
    }
    let wanted = |name: &&str| saved.recording.is_none() && OF_RECORDINGS.contains(name);
    for name in NAMES.iter().chain(&OF_RECORDINGS).filter(|name| !wanted(name)) {
        match came.get(name) {
            Some(1) => {}
            None => return Err(damaged(&format!("the section `{name}` is missing"))),
            Some(_) => return Err(damaged(&format!("the section `{name}` is there twice"))),
        }
    }
    if saved.recording.as_ref().is_some_and(|recording| !recording.is_sound()) {
        return Err(damaged("what it says of its run does not fit together"));
    }
    if saved.checkpoint.state.hash() != hash {
        return Err(damaged("its positions and velocities do not match their hash"));
    }
    Ok(saved)
}

/// Parameters as they are before the section that holds them: all zero.
const NO_PARAMETERS: [u8; 8 + 4 + 12 + 4 * 8] = [0; 56];

fn read_section(saved: &mut Saved, hash: &mut u64, name: &str, content: &[u8]) -> Result<()> {
    let Checkpoint { state, params, keeps_ledger } = &mut saved.checkpoint;
    let params = Arc::make_mut(params);
    let mut read = Unpack::new(content);
    match name {
        "about" => {
            saved.program = read.text()?.to_owned();
            saved.scene_name = read.text()?.to_owned();
            saved.fingerprint = read.u64()?;
            *hash = read.u64()?;
            *keeps_ledger = read.bool()?;
        }
        "scene" => {
            let text = std::str::from_utf8(content);
            let text = text.map_err(|_| Error::new(Code::Unreadable, "is not UTF-8"))?;
            saved.scene = text.to_owned();
            return Ok(());
        }
        "clock" => read_clock(&mut read, state)?,
        "positions" => state.position = read.vec3s()?,
        "positions-low" => state.position_low = read.vec3s()?,
        "velocities" => state.velocity = read.vec3s()?,
        "velocities-low" => state.velocity_low = read.vec3s()?,
        "parameters" => {
            // The arrays have sections of their own.
            *params = Params {
                point_mass: params.point_mass.clone(),
                point_pinned: params.point_pinned.clone(),
                spring_stiffness: params.spring_stiffness.clone(),
                spring_damping: params.spring_damping.clone(),
                spring_rest_length: params.spring_rest_length.clone(),
                spring_cut: params.spring_cut.clone(),
                ..read.short_params()?
            };
        }
        "masses" => params.point_mass = Arc::new(read.f32s()?),
        "pins" => params.point_pinned = Arc::new(read.bools()?),
        "stiffness" => params.spring_stiffness = Arc::new(read.f32s()?),
        "damping" => params.spring_damping = Arc::new(read.f32s()?),
        "rest-lengths" => params.spring_rest_length = Arc::new(read.f32s()?),
        "cuts" => params.spring_cut = Arc::new(read.bools()?),
        "meshes" => saved.meshes = read.meshes()?,
        "run" => {
            let plan: Plan = serde_json::from_slice(content)
                .map_err(|error| Error::new(Code::Unreadable, format!("cannot be understood: {error}")))?;
            saved.recording.get_or_insert_with(empty_recording).plan = plan;
            return Ok(());
        }
        _ => saved.recording.get_or_insert_with(empty_recording).marks = read_marks(&mut read)?,
    }
    read.end()
}

fn empty_recording() -> Recording {
    Recording { plan: Plan::default(), marks: Vec::new() }
}

fn read_clock(read: &mut Unpack<'_>, state: &mut State) -> Result<()> {
    (state.step, state.time) = (read.u64()?, read.f64()?);
    state.set_clock((read.u64()?, read.f64()?));
    state.ledger = LedgerSums {
        start: read.f64()?,
        work_in: read.f64()?,
        lost_in_dampers: read.f64()?,
        lost_in_contact: read.f64()?,
        integrator_error: read.f64()?,
        suspect_steps: read.u64()?,
    };
    Ok(())
}

fn read_marks(read: &mut Unpack<'_>) -> Result<Vec<Mark>> {
    let mut marks = Vec::new();
    for _ in 0..read.u64()? {
        let frames = read.u64()?;
        let mut files = Vec::new();
        for _ in 0..read.u64()? {
            let part = read.text()?;
            // It becomes part of a file's name, and may lead nowhere else.
            if !part.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'-') {
                return Err(Error::new(Code::Unreadable, "names a file that there cannot be"));
            }
            let part = part.to_owned();
            files.push(FileMark { part, bytes: read.u64()?, head: read.u64()?, crc32: read.u32()? });
        }
        marks.push(Mark { frames, files, memory: read.bytes()?.to_vec() });
    }
    Ok(marks)
}
