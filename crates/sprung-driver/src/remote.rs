//! A driver elsewhere, as its front end holds it: messages out, words in.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError};

use sprung::Result;

use crate::command::{Beginning, Command};
use crate::driver::Driver;
use crate::options::Options;
use crate::report::Report;
use crate::wire::{Fingerprint, FromHost, Reader, Start, ToHost, Wire, damaged};

/// What comes from where a [`Host`](crate::Host) works.
#[derive(Clone, Debug)]
pub enum Word {
    /// A message of the host.
    Message(Vec<u8>),
    /// There will be no more, for this reason.
    Ended(String),
}

/// Takes a message to where a [`Host`](crate::Host) works.
#[cfg(not(target_arch = "wasm32"))]
pub type Post = Box<dyn FnMut(Vec<u8>) + Send>;

/// Takes a message to where a [`Host`](crate::Host) works. What a page has of its worker stays on its thread.
#[cfg(target_arch = "wasm32")]
pub type Post = Box<dyn FnMut(Vec<u8>)>;

/// The front end's side.
pub(crate) struct Remote {
    post: Post,
    words: Receiver<Word>,
    reader: Reader,
    options: Options,
    /// What the first report was made of.
    fingerprint: Fingerprint,
    /// Nothing comes any more.
    has_ended: bool,
}

impl Remote {
    pub fn new(
        beginning: Beginning,
        options: Options,
        mut post: Post,
        words: Receiver<Word>,
    ) -> Result<Self> {
        let start = Start { beginning, options: options.clone() };
        let first = start.to_bytes()?;
        // From the very bytes that the other end has, so that both begin with the same.
        let mut driver = Driver::with(Start::from_bytes(&first)?.beginning, options.clone())?;
        post(first);
        let fingerprint = driver.fingerprint();
        let reader = Reader::new(driver.report(), options.clone());
        Ok(Self { post, words, reader, options, fingerprint, has_ended: false })
    }

    pub fn send(&mut self, command: &Command) {
        let command = match command {
            Command::GoOn(kept) => Command::GoOn(kept.brought(&self.options)),
            command => command.clone(),
        };
        self.tell(&ToHost::Command(command));
    }

    /// The newest report, after all that has come.
    pub fn report(&mut self) -> Arc<Report> {
        while !self.has_ended {
            match self.words.try_recv() {
                Ok(Word::Message(message)) => self.hear(&message),
                Ok(Word::Ended(reason)) => self.end(&reason),
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => self.end("it is gone"),
            }
        }
        self.reader.last.clone()
    }

    fn hear(&mut self, message: &[u8]) {
        let heard = FromHost::read(message).and_then(|message| match message {
            FromHost::Greeting(theirs) if theirs == self.fingerprint => Ok(()),
            FromHost::Greeting(_) => Err(damaged("tells of another beginning than there is here")),
            FromHost::Report(bytes) => {
                self.reader.read(bytes)?;
                self.tell(&ToHost::Heard);
                Ok(())
            }
        });
        if let Err(error) = heard {
            self.end(&error.to_string());
        }
    }

    fn tell(&mut self, message: &ToHost) {
        if !self.has_ended {
            (self.post)(message.to_bytes());
        }
    }

    fn end(&mut self, reason: &str) {
        self.has_ended = true;
        self.reader.last = Arc::new(self.reader.last.ended(reason));
    }
}
