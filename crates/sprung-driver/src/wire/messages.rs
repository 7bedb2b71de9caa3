//! What a message is.

use sprung::Result;
use sprung_io::{Pack, Unpack};

use crate::command::Command;

use super::{Wire, damaged, enums, structs};

/// A message to a driver. Before all of them goes a [`Start`](super::Start).
pub(crate) enum ToHost {
    Command(Command),
    /// A report has been taken in.
    Heard,
}

enums! {
    ToHost { 0 Command(command), 1 Heard }
}

/// Of what a driver says first: whether both ends hold the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fingerprint {
    pub model: u64,
    pub state: u64,
}

structs! {
    Fingerprint { model, state }
}

/// A message from a driver.
pub(crate) enum FromHost<'a> {
    /// The first.
    Greeting(Fingerprint),
    /// The bytes of a report.
    Report(&'a [u8]),
}

const GREETING: u8 = 0;
const REPORT: u8 = 1;

impl<'a> FromHost<'a> {
    pub fn greeting(fingerprint: Fingerprint) -> Vec<u8> {
        let mut pack = Pack::new();
        pack.u8(GREETING);
        fingerprint.write(&mut pack);
        pack.into_bytes()
    }

    /// Begins a report: what it says comes behind.
    pub fn begin_report(pack: &mut Pack) {
        pack.u8(REPORT);
    }

    pub fn read(bytes: &'a [u8]) -> Result<Self> {
        match bytes.split_first() {
            Some((&GREETING, rest)) => {
                let mut read = Unpack::new(rest);
                let fingerprint = Fingerprint::read(&mut read)?;
                read.end().map(|()| Self::Greeting(fingerprint))
            }
            Some((&REPORT, rest)) => Ok(Self::Report(rest)),
            _ => Err(damaged("is none")),
        }
    }
}
