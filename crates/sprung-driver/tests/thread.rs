//! The driver on a thread: it plays, sleeps, hears, ends, and survives its own panics.

mod common;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use common::{check, source};
use sprung::Workers;
use sprung_driver::{Command, Driver, Handle, Options, Report, Trouble};

/// Longer than anything here takes on any machine: only a hang gets there.
const HANG: Duration = Duration::from_secs(120);

/// A threaded driver, and word of every new report.
fn start(driver: Driver) -> (Handle, Receiver<()>) {
    let (sender, receiver) = channel();
    // The test may have ended by then.
    let wake = Box::new(move || {
        let _ = sender.send(());
    });
    (Handle::thread(driver, wake).expect("a thread"), receiver)
}

/// Waits for a report of which this holds.
fn wait_for(
    handle: &mut Handle,
    woken: &Receiver<()>,
    what: &str,
    holds: impl Fn(&Report) -> bool,
) -> Arc<Report> {
    loop {
        let report = handle.report();
        check(&report);
        if holds(&report) {
            return report;
        }
        assert!(woken.recv_timeout(HANG).is_ok(), "waiting for {what}, it went quiet");
    }
}

fn driver(name: &str) -> Driver {
    Driver::new(source(name)).expect("it opens")
}

#[test]
fn it_plays_pauses_seeks_and_goes_on() {
    let (mut handle, woken) = start(driver("jelly"));
    assert_eq!(handle.report().now.step, 0);
    handle.send(Command::Play(true));
    wait_for(&mut handle, &woken, "some steps", |report| {
        report.now.step >= 20 && report.seconds_per_step > 0.0
    });
    handle.send(Command::Play(false));
    let paused = wait_for(&mut handle, &woken, "the pause", |report| !report.playing);
    handle.send(Command::Seek(5));
    let five =
        wait_for(&mut handle, &woken, "step 5", |report| report.now.step == 5 && report.busy.is_none());
    assert_eq!(five.timeline.newest.0, paused.now.step);
    handle.send(Command::Seek(paused.now.step));
    let back = wait_for(&mut handle, &woken, "the newest", |report| report.now.step == paused.now.step);
    assert_eq!(back.now, paused.now);
    handle.pass(1.0);
}

#[test]
fn while_paused_it_sleeps() {
    let (mut handle, woken) = start(driver("chain"));
    handle.send(Command::Step);
    wait_for(&mut handle, &woken, "the step", |report| report.now.step == 1);
    while woken.recv_timeout(Duration::from_millis(300)).is_ok() {}
    let before = handle.report();
    assert!(woken.recv_timeout(Duration::from_millis(300)).is_err(), "a report though nothing happens");
    assert!(Arc::ptr_eq(&before, &handle.report()));
}

#[test]
fn dropping_the_handle_ends_it_whatever_it_does() {
    let busy = [
        vec![],
        vec![Command::Play(true)],
        vec![Command::Settle],
        vec![Command::Open(Box::new(source("cloth")))],
        vec![
            Command::Edit(sprung_driver::Edit::new("many", vec![sprung::Change::Substeps(1_000_000)])),
            Command::Frame,
        ],
    ];
    for commands in busy {
        let (mut handle, woken) = start(driver("jelly"));
        commands.into_iter().for_each(|command| handle.send(command));
        drop(handle);
        // The sender of the wakes lives on the thread: it is gone when that has ended.
        while woken.try_recv().is_ok() {}
        assert!(
            woken
                .recv_timeout(HANG)
                .is_err_and(|error| error == std::sync::mpsc::RecvTimeoutError::Disconnected)
        );
    }
}

/// A scene large enough for the engine to call on other threads.
const LARGE: &str = "cloth512";

/// Threads that stand still while the gate is shut.
struct Gated {
    gate: Mutex<()>,
    has_come: Mutex<Sender<()>>,
}

impl Workers for Gated {
    fn count(&self) -> usize {
        2
    }

    fn run(&self, job: &(dyn Fn(usize) + Sync)) {
        // Whoever waited for this may have gone.
        let _ = self.has_come.lock().expect("nobody dies").send(());
        let _open = self.gate.lock().expect("nobody dies");
        (0..2).for_each(job);
    }
}

/// As the search for the true limit of a large model does, which takes seconds.
#[test]
fn dropping_the_handle_does_not_wait_for_what_cannot_be_broken_off() {
    let (has_come, coming) = channel();
    let workers = Arc::new(Gated { gate: Mutex::new(()), has_come: Mutex::new(has_come) });
    let options = Options { workers: workers.clone(), ..Options::default() };
    let (mut handle, woken) = start(Driver::with(source(LARGE), options).expect("it opens"));
    let shut = workers.gate.lock().expect("nobody dies");
    handle.send(Command::Step);
    coming.recv_timeout(HANG).expect("it steps");
    // In a thread of its own, so that this test would fail, and not hang.
    let (has_dropped, dropped) = channel();
    std::thread::spawn(move || {
        drop(handle);
        has_dropped.send(()).expect("somebody waits for it");
    });
    dropped.recv_timeout(HANG).expect("it is dropped while the step stands still");
    drop(shut);
    // Let go, the thread ends, and with it the sender of wakes.
    while woken.try_recv().is_ok() {}
    assert_eq!(woken.recv_timeout(HANG), Err(std::sync::mpsc::RecvTimeoutError::Disconnected));
}

#[test]
fn settling_is_broken_off_by_whatever_comes_next() {
    let source = common::source_with("jelly", &[]);
    let never = sprung::SettleOptions { residual_force: Some(0.0), max_steps: u64::MAX - 1 };
    let options = Options { settle: never, ..Options::default() };
    let (mut handle, woken) = start(Driver::with(source, options).expect("it opens"));
    handle.send(Command::Settle);
    let busy = |report: &Report| report.busy.as_deref().is_some_and(|busy| busy.starts_with("settling:"));
    wait_for(&mut handle, &woken, "settling", busy);
    handle.send(Command::WantForces(true));
    handle.send(Command::Step);
    let report = wait_for(&mut handle, &woken, "the step", |report| report.now.step == 1);
    assert!(report.trouble.is_none(), "{:?}", report.trouble);
    let forces = wait_for(&mut handle, &woken, "forces", |report| report.forces.is_some());
    assert_eq!(forces.forces.as_ref().map(|forces| forces.len()), Some(1000));
}

#[test]
fn another_scene_comes_while_it_plays() {
    let (mut handle, woken) = start(driver("chain"));
    handle.send(Command::Play(true));
    handle.send(Command::Open(Box::new(source("cloth"))));
    let report =
        wait_for(&mut handle, &woken, "the cloth", |report| report.opened.serial == 2 && report.now.step > 3);
    assert_eq!((&*report.opened.name, report.playing), ("cloth", true));
}

/// Threads of which one dies after some steps.
struct Dying(AtomicUsize);

impl Workers for Dying {
    fn count(&self) -> usize {
        2
    }

    fn run(&self, job: &(dyn Fn(usize) + Sync)) {
        assert!(self.0.fetch_add(1, Ordering::Relaxed) < 10, "a worker died");
        (0..2).for_each(job);
    }
}

#[test]
fn a_panic_becomes_a_report_and_not_a_hang() {
    let options = Options { workers: Arc::new(Dying(AtomicUsize::new(0))), ..Options::default() };
    let (mut handle, woken) = start(Driver::with(source(LARGE), options).expect("it opens"));
    handle.send(Command::Play(true));
    let report = wait_for(&mut handle, &woken, "the panic", |report| report.trouble.is_some());
    let Some(Trouble::Refused(error)) = &report.trouble else { panic!("{:?}", report.trouble) };
    assert!(error.sentence().contains("a worker died"), "{error}");
    assert!(!report.playing && report.busy.is_none());
    handle.send(Command::Play(true));
    handle.send(Command::Reset);
    assert!(handle.report().trouble.is_some());
}
