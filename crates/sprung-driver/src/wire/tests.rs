//! What goes over the wire comes out as it was, and what is damaged does no harm.

#[path = "../../tests/common/acts.rs"]
mod acts;

use std::sync::Arc;

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use sprung::scene::Scene;
use sprung::{BlowUp, Cause, Change, Code, Error, Params, Simulation, Vec3};

use super::*;
use crate::command::{Beginning, Command, Edit, Source};
use crate::driver::Driver;
use crate::kept::{Kept, Running};
use crate::options::Options;
use crate::report::Report;

use acts::{Act, act};

/// So many random cases, the same ones on every machine.
fn cases(count: u32) -> Config {
    let rng_seed = RngSeed::Fixed(5);
    Config { rng_seed, failure_persistence: None, ..Config::with_cases(count) }
}

fn source(name: &str) -> Source {
    Source { name: name.to_owned(), scene: Scene::builtin(name).expect("a built-in scene") }
}

/// As the other end has it.
fn sent<T: Wire>(value: &T) -> T {
    T::from_bytes(&value.to_bytes()).expect("it was written")
}

/// All that a report says but for its scene, which is told when it is opened.
fn told(report: &Report, opened: &Report) -> String {
    format!("{:?}", Report { opened: opened.opened.clone(), ..report.clone() })
}

/// What goes on with the moment that a driver keeps.
fn kept(driver: &mut Driver) -> Option<Kept> {
    let report = driver.report();
    let (name, scene) = (report.opened.name.clone(), report.opened.scene.clone());
    let checkpoint = report.checkpoint.clone()?;
    Some(Kept::elsewhere(name.clone(), move |_| {
        let (model, params, _) = scene.build()?;
        let simulation = Simulation::resume_from(model, (*checkpoint).clone())?;
        Ok(Running { name: name.clone(), scene: scene.clone(), params: Arc::new(params), simulation })
    }))
}

/// A driver here, one at the other end, and the latter's reports here.
struct Both {
    here: Driver,
    there: Driver,
    writer: Writer,
    reader: Reader,
    /// Every message that has gone over.
    commands: Vec<Vec<u8>>,
    reports: Vec<Vec<u8>>,
}

impl Both {
    fn new(beginning: impl Into<Beginning>) -> Self {
        let start = Start { beginning: beginning.into(), options: acts::options() };
        let theirs = Start::from_bytes(&start.to_bytes().expect("it is small")).expect("it was written");
        let mut here = Driver::with(start.beginning, start.options).expect("it opens");
        let mut there = Driver::with(theirs.beginning, theirs.options).expect("it opens");
        assert_eq!(here.fingerprint(), there.fingerprint());
        let (writer, reader) = (Writer::new(there.report()), Reader::new(here.report(), Options::default()));
        Self { here, there, writer, reader, commands: Vec::new(), reports: Vec::new() }
    }

    fn act(&mut self, act: Act) {
        act.clone().act(&mut self.here, &mut Driver::obey, &kept);
        let commands = &mut self.commands;
        let obey = &mut |driver: &mut Driver, command: Command| {
            let command = match command {
                Command::GoOn(kept) => Command::GoOn(kept.brought(&Options::default())),
                command => command,
            };
            commands.push(ToHost::Command(command).to_bytes());
            let Ok(ToHost::Command(command)) = ToHost::from_bytes(&commands[commands.len() - 1]) else {
                panic!("it was written");
            };
            driver.obey(command);
        };
        act.act(&mut self.there, obey, &kept);
    }

    fn report(&mut self) {
        let (last, report) = (self.reader.last.clone(), self.there.report());
        let was = self.writer.last().clone();
        let message = self.writer.write(&report);
        let Ok(FromHost::Report(bytes)) = FromHost::read(&message) else { panic!("it is a report") };
        self.reader.read(bytes).expect("it was written");
        self.reports.push(message);
        let (here, read) = (self.here.report(), &self.reader.last);
        assert_eq!(told(&here, &last), told(read, &last));
        // What was shared there is shared here.
        assert_eq!(Arc::ptr_eq(&report.opened, &was.opened), Arc::ptr_eq(&read.opened, &last.opened));
        assert_eq!(Arc::ptr_eq(&report.params, &was.params), Arc::ptr_eq(&read.params, &last.params));
        assert_eq!(
            Arc::ptr_eq(&report.params.spring_stiffness, &was.params.spring_stiffness),
            Arc::ptr_eq(&read.params.spring_stiffness, &last.params.spring_stiffness)
        );
        if Arc::ptr_eq(&report.now, &was.now) {
            assert!(Arc::ptr_eq(&read.now, &last.now));
        }
        if !Arc::ptr_eq(&read.opened, &last.opened) {
            let [here, there, read] = [&here.opened, &report.opened, &read.opened];
            assert_eq!((here.serial, &here.name, &here.scene), (read.serial, &read.name, &read.scene));
            assert_eq!((&here.model, &here.params, &here.first), (&read.model, &read.params, &read.first));
            assert_eq!(there.scene.provenance(), read.scene.provenance());
        }
    }
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn a_driver_at_the_other_end_says_what_one_here_says(
        acts in prop::collection::vec((act(), 0..3u8), 1..150)
    ) {
        let mut both = Both::new(source("chain"));
        for (act, reports) in acts {
            both.act(act);
            // Now and then none is sent, or one though nothing has happened.
            (0..reports).for_each(|_| both.report());
        }
        both.report();
        prop_assert_eq!(both.here.state_hash(), both.there.state_hash());
    }
}

#[test]
fn a_simulation_under_way_begins_at_the_other_end() {
    let mut simulation = source("jelly").scene.simulation().expect("it is built");
    simulation.steps(50).expect("it is stable");
    let Source { name, scene } = source("jelly");
    let params = Arc::new(scene.build().expect("it is built").1);
    let mut both = Both::new(Running { name, scene, params, simulation });
    both.act(Act::Send(Command::Play(true)));
    for _ in 0..20 {
        both.act(Act::Pass(0.02, 9));
        both.report();
    }
    assert_eq!(both.reader.last.now.step, 90);
}

#[test]
fn of_a_step_that_is_known_only_the_next_one_is_sent() {
    let mut both = Both::new(source("jelly"));
    both.act(Act::Send(Command::Play(true)));
    let mut sizes = Vec::new();
    for _ in 0..5 {
        both.act(Act::Pass(0.01, 9));
        both.report();
        sizes.push(both.reports[both.reports.len() - 1].len());
    }
    let snapshot = 24 * both.reader.last.opened.model.point_count();
    assert!(sizes.iter().all(|&bytes| bytes > snapshot && bytes < snapshot + 2000), "{sizes:?}");
    // Two steps on, the one between is not known.
    both.act(Act::Pass(0.02, 9));
    both.report();
    assert!(both.reports[5].len() > 2 * snapshot);
    both.report();
    assert!(both.reports[6].len() < 2000, "nothing has moved");
}

#[test]
fn of_parameters_only_the_array_is_sent_that_has_changed() {
    let mut both = Both::new(source("jelly"));
    both.report();
    let springs = both.reader.last.opened.model.spring_count();
    let edit = Edit::new("stiffness", vec![Change::Stiffness(0..springs, 900.0)]);
    both.act(Act::Send(Command::Edit(edit)));
    both.report();
    both.act(Act::Send(Command::Undo));
    both.report();
    let sizes: Vec<_> = both.reports[1..].iter().map(Vec::len).collect();
    assert!((4 * springs..4 * springs + 2000).contains(&sizes[0]) && sizes[1] < 2000, "{sizes:?}");
    assert_eq!(both.reader.last.params, both.reader.last.opened.params);
}

#[test]
fn what_is_small_is_read_as_it_was() {
    let blow_up = BlowUp {
        cause: Cause::EnergyFromNowhere { excess: 1.5 },
        step: 9,
        time: 0.25,
        good_step: 3,
        good_time: 0.125,
        spring: Some(7),
        points: vec![1, 2],
        owner: "sheet".into(),
        place: "spring 7 of sheet".into(),
        dt: 0.01,
        damping_scale: Some(0.5),
        dt_limit_certified: None,
        dt_limit_every_configuration: Some(0.003),
    };
    let error = Error::new(Code::TooLarge, "has 9 points").at_field("body[0]").with_fix("use fewer");
    let errors = [
        error.clone(),
        error.in_file("a.toml").at_line(3, 4),
        Error::from_blow_up(BlowUp { cause: Cause::NotFinite, ..blow_up.clone() }),
        Error::from_blow_up(blow_up).in_file("b.toml"),
    ];
    for error in errors {
        assert_eq!(sent(&error), error);
    }
    for code in Code::ALL {
        assert_eq!(sent(&code), code);
    }
    let params: Params = source("spring").scene.build().expect("it is built").1;
    let changes = vec![
        Change::Planes(params.planes.clone()),
        Change::Grab(sprung::Grab { point: 3, target: Vec3::X, stiffness: 0.5, damping: -0.0 }),
        Change::Release(1),
        Change::Carry(2, None),
        Change::Carry(2, Some(Vec3::Y)),
        Change::Params(Arc::new(params)),
    ];
    assert_eq!(sent(&changes), changes);
}

/// With the line at fault, though the build fails where no file is.
#[test]
fn errors_of_a_scene_are_found_at_the_same_place() {
    let text = "[[body]]\nname = \"a\"\npoints = [[0, 0, 0], [9, 0, 0]]\npoint_mass = 1\n\n\
                [[body.springs]]\nradius = 2\nstiffness = 1\ndamping = 0\n";
    let mut scene = Scene::parse(text, "x.toml").expect("what is wrong is found when it is built");
    let here = scene.build().expect_err("no points that near");
    assert!(here.place().line_column.is_some());
    assert_eq!(sent(&scene).build().expect_err("as here"), here);
    assert_eq!(sent(&scene), scene);
    scene.set("substeps", "3").expect("it is allowed");
    assert_eq!(sent(&scene).provenance(), scene.provenance());
}

#[test]
fn meshes_go_with_their_scene() {
    let text = "[[body]]\nname = \"a\"\nmesh = \"a.obj\"\ncloth = { density = 1, stiffness = 100 }\n";
    let mut scene = Scene::parse(text, "x.toml").expect("it is a scene");
    let positions = vec![sprung::DVec3::ZERO, sprung::DVec3::X, sprung::DVec3::Z];
    let mut mesh = sprung::build::Mesh { positions, ..Default::default() };
    mesh.faces.push(&[0, 1, 2]);
    scene.load_meshes(&mut |_| Ok(mesh.clone())).expect("it is sound");
    let read = sent(&scene);
    assert_eq!(read, scene);
    assert_eq!(
        read.build().map(|built| built.0.fingerprint()),
        scene.build().map(|built| built.0.fingerprint())
    );
}

/// Messages of every kind.
fn messages() -> (Both, Vec<u8>) {
    let mut both = Both::new(source("chain"));
    let springs = both.reader.last.opened.model.spring_count();
    let commands = [
        Command::Play(true),
        Command::Watch(vec![crate::Probe::Speed(3)]),
        Command::WantForces(true),
        Command::Edit(Edit::new("softer", vec![Change::Stiffness(0..springs, 10.0), Change::Dt(0.005)])),
        Command::Pull(crate::Pull { point: 14, target: Vec3::splat(3.0), hard: false }),
        Command::Release,
        Command::Checkpoint(true),
        Command::RewindAndGoOn(0.05),
        Command::Compare(true),
        Command::Seek(10_000),
        Command::Open(Box::new(source("spring"))),
    ];
    for command in commands {
        both.act(Act::Send(command));
        both.act(Act::Pass(0.05, 9));
        both.report();
    }
    let start = Start { beginning: source("chain").into(), options: Options::default() };
    (both, start.to_bytes().expect("it is small"))
}

/// Little memory: a scene that a flipped bit made large is refused.
fn options() -> Options {
    Options { memory_limit: Some(32 << 20), ..Options::default() }
}

/// Reads bytes as every kind of message, and gives whether they can be one.
fn try_all(bytes: &[u8], last: &Arc<Report>) -> [bool; 3] {
    let mut reads = [false; 3];
    let used = allocation_counter::measure(|| {
        let report = FromHost::read(bytes).and_then(|message| match message {
            FromHost::Greeting(_) => Ok(()),
            FromHost::Report(bytes) => Reader::new(last.clone(), options()).read(bytes),
        });
        reads = [ToHost::from_bytes(bytes).is_ok(), report.is_ok(), Start::from_bytes(bytes).is_ok()];
    });
    assert!(used.bytes_max < 64 << 20, "{} bytes", used.bytes_max);
    reads
}

#[test]
fn what_is_cut_off_is_refused() {
    let (both, start) = messages();
    let last = &both.reader.last;
    for (kind, message) in both
        .commands
        .iter()
        .map(|bytes| (0, bytes))
        .chain(both.reports.iter().map(|bytes| (1, bytes)))
        .chain([(2, &start)])
    {
        // Of what is long, most is numbers.
        for length in (0..message.len()).step_by(1 + message.len() / 300) {
            assert!(!try_all(&message[..length], last)[kind], "{length} bytes of {}", message.len());
        }
    }
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn what_is_damaged_does_no_harm(
        flips in prop::collection::vec((any::<prop::sample::Index>(), 0..8u32), 1..4),
        noise in prop::collection::vec(any::<u8>(), 0..200),
    ) {
        thread_local!(static MESSAGES: (Both, Vec<u8>) = messages());
        MESSAGES.with(|(both, start)| {
            let last = &both.reader.last;
            for message in both.commands.iter().chain(&both.reports).chain([start, &noise]) {
                let mut bytes = message.clone();
                for (place, bit) in &flips {
                    if !bytes.is_empty() {
                        let place = place.index(bytes.len());
                        bytes[place] ^= 1 << bit;
                    }
                }
                try_all(&bytes, last);
            }
        });
    }
}
