//! A driver on a thread of its own: commands go in through a channel, the newest report comes out through a mutex.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use sprung::{Code, Error, Result};
use web_time::Instant;

use crate::command::Command;
use crate::driver::Driver;
use crate::report::Report;
use crate::turns::Turns;

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
        if !self.quits() {
            lock(&self.wake)();
        }
    }

    /// As the last report, but paused for good.
    fn publish_end(&self, panic: &(dyn Any + Send)) {
        let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        let end = lock(&self.newest).ended(text.as_deref().unwrap_or("it does not say why"));
        self.publish(Arc::new(end));
    }

    fn quits(&self) -> bool {
        self.quits.load(Ordering::Relaxed)
    }
}

/// A mutex whose holder panicked still holds a whole value: each is replaced in one go.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The driver's side.
struct Worker {
    turns: Turns,
    receiver: Receiver<Command>,
    is_open: bool,
    shared: Arc<Shared>,
}

impl Worker {
    fn new(driver: Driver, receiver: Receiver<Command>, wake: Box<dyn Fn() + Send>) -> Self {
        let begun = Instant::now();
        let turns = Turns::new(driver, Box::new(move || begun.elapsed()));
        let newest = Mutex::new(turns.newest().clone());
        let shared = Shared { newest, quits: AtomicBool::new(false), wake: Mutex::new(wake) };
        Self { turns, receiver, is_open: true, shared: Arc::new(shared) }
    }

    /// Until the front end is gone.
    fn work(mut self) {
        while self.is_open || self.turns.has_heard() {
            self.wait();
            self.listen();
            if self.shared.quits() {
                return;
            }
            let shared = self.shared.clone();
            let report = self.turns.turn(&|| !shared.quits());
            if !Arc::ptr_eq(&report, &lock(&shared.newest)) {
                shared.publish(report);
            }
        }
    }

    /// Sleeps until there is something to do.
    fn wait(&mut self) {
        match self.turns.rest() {
            None => match self.receiver.recv() {
                Ok(command) => self.turns.hear(command),
                Err(_) => self.is_open = false,
            },
            Some(rest) if !rest.is_zero() => match self.receiver.recv_timeout(rest) {
                Ok(command) => self.turns.hear(command),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => self.is_open = false,
            },
            Some(_) => {}
        }
    }

    /// Takes in what has come.
    fn listen(&mut self) {
        loop {
            match self.receiver.try_recv() {
                Ok(command) => self.turns.hear(command),
                Err(TryRecvError::Empty) => return,
                Err(TryRecvError::Disconnected) => {
                    self.is_open = false;
                    return;
                }
            }
        }
    }
}
