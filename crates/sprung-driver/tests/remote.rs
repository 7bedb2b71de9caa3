//! A driver at the far end of a wire, and what becomes of it.

mod common;

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use common::{check, kept, source};
use sprung::{Code, Error};
use sprung_driver::{Command, Driver, Handle, Host, Kept, Options, Report, Source, Trouble, Word};

/// Both ends, on one thread.
struct Wire {
    handle: Handle,
    host: Host,
    to_host: Receiver<Vec<u8>>,
    to_page: Sender<Word>,
}

impl Wire {
    fn new(source: Source, options: Options) -> Self {
        let ((messages, to_host), (to_page, words)) = (channel(), channel());
        let post = Box::new(move |message| messages.send(message).expect("somebody hears"));
        let handle = Handle::remote(source, options, post, words).expect("it opens");
        let host = Host::new(&to_host.recv().expect("what it begins with")).expect("it opens");
        Self { handle, host, to_host, to_page }
    }

    /// The host hears, works and tells. Gives how many messages it sent.
    fn turn(&mut self) -> usize {
        self.to_host.try_iter().for_each(|message| self.host.hear(&message));
        let rest = self.host.turn();
        std::thread::sleep(rest.unwrap_or_default().min(Duration::from_millis(10)));
        let messages = std::iter::from_fn(|| self.host.report());
        messages.map(|message| self.to_page.send(Word::Message(message)).expect("somebody hears")).count()
    }

    /// Turns until there is a report of which this holds.
    fn until(&mut self, what: &str, holds: impl Fn(&Report) -> bool) -> Arc<Report> {
        for _ in 0..100_000 {
            let report = self.handle.report();
            check(&report);
            if holds(&report) {
                return report;
            }
            self.turn();
        }
        panic!("waiting for {what}: {:?}", self.handle.report().trouble);
    }
}

fn refusal(report: &Report) -> String {
    match &report.trouble {
        Some(Trouble::Refused(error)) => error.to_string(),
        trouble => panic!("{trouble:?}"),
    }
}

#[test]
fn it_plays_opens_and_keeps_as_one_here() {
    let mut wire = Wire::new(source("jelly"), Options::default());
    let first = wire.handle.report();
    assert_eq!((first.now.step, first.opened.serial), (0, 1));
    wire.handle.send(Command::Play(true));
    wire.until("some steps", |report| report.now.step >= 20 && report.seconds_per_step > 0.0);
    wire.handle.send(Command::Play(false));
    let paused = wire.until("the pause", |report| !report.playing);
    assert!(Arc::ptr_eq(&first.opened, &paused.opened));
    wire.handle.send(Command::Checkpoint(true));
    let moment = wire.until("the checkpoint", |report| report.checkpoint.is_some());
    wire.handle.send(Command::Open(Box::new(source("chain"))));
    let chain = wire.until("the chain", |report| report.opened.serial == 2 && report.busy.is_none());
    assert_eq!((&*chain.opened.name, chain.now.step), ("chain", 0));
    wire.handle.send(Command::GoOn(kept(&moment)));
    let on = wire.until("the jelly", |report| report.opened.serial == 3);
    assert_eq!((&on.opened.name, &on.now), (&moment.opened.name, &moment.now));
    wire.handle.send(Command::Step);
    wire.until("a step", |report| report.now.step == moment.now.step + 1);
    // As one that never left.
    let mut here = Driver::new(source("jelly")).expect("it opens");
    (0..=moment.now.step).for_each(|_| {
        here.obey(Command::Step);
        here.advance(0.0, &mut || true);
    });
    assert_eq!(wire.host.state_hash(), here.state_hash());
    wire.handle.pass(1.0);
}

#[test]
fn settling_is_broken_off_by_whatever_comes_next() {
    let never = sprung::SettleOptions { residual_force: Some(0.0), max_steps: u64::MAX - 1 };
    let mut wire = Wire::new(source("jelly"), Options { settle: never, ..Options::default() });
    wire.handle.send(Command::Settle);
    wire.until("settling", |report| report.busy.as_deref().is_some_and(|busy| busy.starts_with("settling:")));
    wire.handle.send(Command::WantForces(true));
    wire.until("forces while it settles", |report| report.forces.is_some() && report.busy.is_some());
    wire.handle.send(Command::Step);
    let report = wire.until("the step", |report| report.now.step == 1);
    assert!(report.trouble.is_none());
}

#[test]
fn a_front_end_that_is_slow_is_sent_no_more_than_it_takes_in() {
    let mut wire = Wire::new(source("jelly"), Options::default());
    wire.handle.send(Command::Play(true));
    let sent: usize = (0..50).map(|_| wire.turn()).sum();
    assert_eq!(sent, 3, "a greeting and two reports");
    // It has gone on, and says so when it is heard again.
    let old = wire.handle.report();
    let new = wire.until("news", |report| report.now.step > old.now.step + 5);
    assert!(new.playing);
}

#[test]
fn while_paused_nothing_is_said() {
    let mut wire = Wire::new(source("chain"), Options::default());
    wire.handle.send(Command::Step);
    wire.until("the step", |report| report.now.step == 1);
    wire.turn();
    let before = wire.handle.report();
    assert_eq!((0..20).map(|_| wire.turn()).sum::<usize>(), 0);
    assert!(Arc::ptr_eq(&before, &wire.handle.report()));
    assert_eq!(wire.host.turn(), None);
}

#[test]
fn what_cannot_be_brought_is_refused_with_its_reason() {
    let mut wire = Wire::new(source("chain"), Options::default());
    let refused = || Error::new(Code::Unreadable, "is damaged").in_file("x.sprung");
    wire.handle.send(Command::GoOn(Kept::elsewhere("x.sprung", move |_| Err(refused()))));
    let report = wire.until("the refusal", |report| report.trouble.is_some());
    assert_eq!(refusal(&report), refused().to_string());
    wire.handle.send(Command::GoOn(Kept::in_bytes("y.sprung", *b"no checkpoint")));
    let report =
        wire.until("the other", |report| report.busy.is_none() && refusal(report).contains("y.sprung"));
    assert_eq!(report.opened.serial, 1);
}

#[test]
fn whatever_ends_it_becomes_a_report_and_not_a_hang() {
    let end = |end: &dyn Fn(&mut Wire)| {
        let mut wire = Wire::new(source("chain"), Options::default());
        wire.handle.send(Command::Play(true));
        wire.until("some steps", |report| report.now.step > 2);
        end(&mut wire);
        let report = wire.handle.report();
        check(&report);
        assert!(!report.playing && report.busy.is_none());
        let sentence = refusal(&report);
        assert!(sentence.contains("stopped for good"), "{sentence}");
        // Nobody is asked any more.
        wire.to_host.try_iter().for_each(drop);
        wire.handle.send(Command::Reset);
        assert_eq!(wire.to_host.try_iter().count(), 0);
        sentence
    };
    let say = |word: Word| move |wire: &mut Wire| wire.to_page.send(word.clone()).expect("it hears");
    assert!(end(&say(Word::Ended("the worker died".into()))).contains("the worker died"));
    assert!(end(&say(Word::Message(vec![1, 2, 3]))).contains("a message"));
    assert!(end(&|wire| wire.to_page = channel().0).contains("it is gone"));
    let other = Wire::new(source("jelly"), Options::default()).host.report().expect("a greeting");
    assert!(end(&say(Word::Message(other))).contains("another beginning"));
}

#[test]
fn a_message_that_is_none_is_refused_and_no_more() {
    let mut wire = Wire::new(source("chain"), Options::default());
    wire.host.hear(&[0, 99]);
    let report = wire.until("the refusal", |report| report.trouble.is_some());
    assert!(refusal(&report).contains("a message"), "{}", refusal(&report));
    wire.handle.send(Command::Step);
    wire.until("a step", |report| report.now.step == 1);
    assert!(Host::new(&[]).is_err() && Host::new(&[7; 100]).is_err());
}
