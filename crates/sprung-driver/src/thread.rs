//! A driver on a thread of its own: commands go in through a channel, the newest report comes out through a mutex.

use std::any::Any;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use sprung::{Code, Error, Result};
use web_time::{Duration, Instant};

use crate::command::Command;
use crate::driver::Driver;
use crate::job::{leaves_alone, queue};
use crate::report::{Report, Trouble};
use crate::supervisor::Supervisor;

/// The longest that the driver works before it reports and hears what is asked.
const BUDGET: Duration = Duration::from_millis(8);

/// The shortest and the longest sleep while it plays: reports say where between two steps to draw, but more than a few
/// hundred of them a second are of no use, however short the steps.
const SLEEP: [Duration; 2] = [Duration::from_millis(4), Duration::from_millis(8)];

/// Rest after which the true limit of a large model is looked for, which may take seconds.
const IDLE: Duration = Duration::from_millis(700);

/// From one word on how far a long work is to the next.
const WORD_EVERY: Duration = Duration::from_millis(100);

/// The front end's side.
pub(crate) struct Thread {
    commands: Sender<Command>,
    shared: Arc<Shared>,
}

/// What both sides see.
struct Shared {
    newest: Mutex<Arc<Report>>,
    /// The front end is gone: whatever is under way is of no use any more.
    quits: AtomicBool,
    wake: Mutex<Box<dyn Fn() + Send>>,
}

impl Thread {
    pub fn start(driver: Driver, wake: Box<dyn Fn() + Send>) -> Result<Self> {
        let (sender, receiver) = channel();
        let worker = Worker::new(driver, receiver, wake);
        let shared = worker.shared.clone();
        let theirs = shared.clone();
        let body = move || {
            // Whatever goes wrong in there, the front end hears of it and goes on.
            if let Err(panic) = catch_unwind(AssertUnwindSafe(|| worker.work())) {
                theirs.publish_end(&*panic);
            }
        };
        std::thread::Builder::new().name("driver".to_owned()).spawn(body).map_err(|error| {
            Error::new(Code::Unsupported, format!("the system gives no thread to simulate on: {error}"))
        })?;
        Ok(Self { commands: sender, shared })
    }

    pub fn send(&self, command: Command) {
        // A thread that has ended has said so in its last report.
        let _ = self.commands.send(command);
    }

    pub fn report(&self) -> Arc<Report> {
        lock(&self.shared.newest).clone()
    }
}

impl Drop for Thread {
    fn drop(&mut self) {
        // It ends by itself, at once or after what cannot be broken off, such as the search for a true limit, which may take
        // seconds: nobody waits for that to quit.
        self.shared.quits.store(true, Ordering::Relaxed);
    }
}

impl Shared {
    fn publish(&self, report: Arc<Report>) {
        *lock(&self.newest) = report;
        if !self.quits.load(Ordering::Relaxed) {
            lock(&self.wake)();
        }
    }

    /// As the last report, but busy with this.
    fn publish_busy(&self, what: &str) {
        let report = Report { busy: Some(what.to_owned()), ..(**lock(&self.newest)).clone() };
        self.publish(Arc::new(report));
    }

    /// As the last report, but paused for good.
    fn publish_end(&self, panic: &(dyn Any + Send)) {
        let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        let sentence = format!(
            "the simulation has stopped for good: {}",
            text.as_deref().unwrap_or("it does not say why")
        );
        let error = Error::new(Code::Unsupported, sentence).with_fix(
            "save what you need and start the program anew; this is an error in it, please report it",
        );
        let last = (**lock(&self.newest)).clone();
        let trouble = Some(Trouble::Refused(error));
        self.publish(Arc::new(Report { playing: false, speed: 0.0, busy: None, trouble, ..last }));
    }
}

/// A mutex whose holder panicked still holds a whole value: each is replaced in one go.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The driver's side.
struct Worker {
    driver: Driver,
    inbox: Inbox,
    shared: Arc<Shared>,
    /// When the last turn began.
    then: Instant,
}

impl Worker {
    fn new(mut driver: Driver, receiver: Receiver<Command>, wake: Box<dyn Fn() + Send>) -> Self {
        let newest = Mutex::new(driver.report());
        let shared = Shared { newest, quits: AtomicBool::new(false), wake: Mutex::new(wake) };
        let inbox = Inbox { receiver, heard: VecDeque::new(), is_open: true };
        Self { driver, inbox, shared: Arc::new(shared), then: Instant::now() }
    }

    /// Until the front end is gone.
    fn work(mut self) {
        while self.inbox.is_open || !self.inbox.heard.is_empty() {
            self.wait();
            self.inbox.listen();
            if self.shared.quits.load(Ordering::Relaxed) {
                return;
            }
            self.turn();
        }
    }

    /// Does what was asked, and what is due.
    fn turn(&mut self) {
        let played = self.driver.plays();
        self.obey();
        let now = Instant::now();
        // What went by before something began to play is not owed to it, such as the rest while nothing did.
        let passed =
            if self.driver.plays() == played { now.duration_since(self.then) } else { Duration::ZERO };
        self.then = now;
        let mut turn = Turn { until: now + BUDGET, told: now, inbox: &mut self.inbox, shared: &self.shared };
        self.driver.advance_under(passed.as_secs_f64(), &mut turn);
        self.driver.measured(now.elapsed().as_secs_f64());
        self.publish();
    }

    /// Sleeps until there is something to do.
    fn wait(&mut self) {
        if !self.inbox.heard.is_empty() {
            return;
        }
        if self.driver.wants_sharp() {
            if self.inbox.wait(IDLE) {
                return;
            }
            self.driver.obey(Command::FindSharpLimit);
            self.publish();
        }
        if self.driver.is_idle() {
            self.inbox.wait_forever();
        } else {
            let seconds = self.driver.seconds_to_step();
            let [shortest, longest] = SLEEP.map(|sleep| sleep.as_secs_f64());
            let is_behind = seconds <= 0.0;
            let sleep = if is_behind { 0.0 } else { seconds.clamp(shortest, longest) };
            self.inbox.wait(Duration::from_secs_f64(sleep));
        }
    }

    fn obey(&mut self) {
        while let Some(command) = self.inbox.heard.pop_front() {
            let opens = match &command {
                Command::Open(source) => Some(&source.name),
                Command::GoOn(kept) => Some(&kept.name),
                _ => None,
            };
            if let Some(name) = opens {
                self.shared.publish_busy(&format!("opening {name}"));
            }
            let settles = matches!(command, Command::Settle);
            self.driver.obey(command);
            // Whatever comes after it would break it off.
            if settles && self.inbox.heard.iter().all(leaves_alone) {
                self.publish();
            }
        }
    }

    fn publish(&mut self) {
        let report = self.driver.report();
        if !Arc::ptr_eq(&report, &lock(&self.shared.newest)) {
            self.shared.publish(report);
        }
    }
}

/// Commands, as they come.
struct Inbox {
    receiver: Receiver<Command>,
    heard: VecDeque<Command>,
    is_open: bool,
}

impl Inbox {
    /// Takes in what has come.
    fn listen(&mut self) {
        loop {
            match self.receiver.try_recv() {
                Ok(command) => self.hear(command),
                Err(TryRecvError::Empty) => return,
                Err(TryRecvError::Disconnected) => {
                    self.is_open = false;
                    return;
                }
            }
        }
    }

    fn hear(&mut self, command: Command) {
        queue(&mut self.heard, command);
    }

    /// Sleeps until something comes, so long at the most; gives whether something has.
    fn wait(&mut self, longest: Duration) -> bool {
        match self.receiver.recv_timeout(longest) {
            Ok(command) => self.hear(command),
            Err(RecvTimeoutError::Timeout) => return false,
            Err(RecvTimeoutError::Disconnected) => self.is_open = false,
        }
        true
    }

    fn wait_forever(&mut self) {
        match self.receiver.recv() {
            Ok(command) => self.hear(command),
            Err(_) => self.is_open = false,
        }
    }
}

/// One turn of work: some milliseconds of steps, or longer where work has no portions and nobody asks for anything else.
struct Turn<'a> {
    until: Instant,
    told: Instant,
    inbox: &'a mut Inbox,
    shared: &'a Shared,
}

impl Supervisor for Turn<'_> {
    fn may_go_on(&mut self) -> bool {
        Instant::now() < self.until && !self.shared.quits.load(Ordering::Relaxed)
    }

    fn may_keep_busy(&mut self, what: &str) -> bool {
        self.inbox.listen();
        if self.told.elapsed() >= WORD_EVERY {
            self.told = Instant::now();
            self.shared.publish_busy(what);
        }
        self.inbox.is_open && self.inbox.heard.iter().all(leaves_alone)
    }
}

#[cfg(test)]
mod tests {
    use sprung::scene::Scene;

    use super::*;
    use crate::command::Source;

    fn source(name: &str) -> Source {
        Source { name: name.to_owned(), scene: Scene::builtin(name).expect("a built-in scene") }
    }

    /// A worker that is given its turns by hand, and whoever asks it for something.
    fn worker(name: &str) -> (Worker, Sender<Command>) {
        let (sender, receiver) = channel();
        (Worker::new(Driver::new(source(name)).expect("it opens"), receiver, Box::new(|| {})), sender)
    }

    impl Worker {
        /// A turn so long after the last one, with these commands.
        fn turn_after(&mut self, rest: Duration, commands: impl IntoIterator<Item = Command>) -> Arc<Report> {
            self.inbox.heard.extend(commands);
            self.then = Instant::now().checked_sub(rest).expect("the clock has run for that long");
            self.turn();
            self.driver.report()
        }
    }

    const REST: Duration = Duration::from_secs(2);

    #[test]
    fn the_time_of_a_pause_is_not_made_up_for() {
        let (mut worker, _sender) = worker("chain");
        for _ in 0..2 {
            let paused = worker.turn_after(REST, [Command::Play(false)]);
            let begun = worker.turn_after(REST, [Command::Play(true)]);
            assert_eq!((begun.now.step, begun.speed), (paused.now.step, 1.0), "playing begins now");
            // While it plays, time is made up for.
            assert!(worker.turn_after(REST, []).now.step > begun.now.step);
        }
    }

    #[test]
    fn the_time_of_opening_is_not_owed_to_the_scene_that_was_opened() {
        let (mut worker, _sender) = worker("chain");
        worker.turn_after(REST, [Command::Play(true)]);
        let report = worker.turn_after(REST, [Command::Open(Box::new(source("chain")))]);
        assert_eq!((report.now.step, report.playing, report.speed), (0, true, 1.0));
    }
}
