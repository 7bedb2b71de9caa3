//! Commands and reports as bytes, for a driver that shares no memory with its front end.
//!
//! Both ends come from one build, and tell each other so: the layout is between them, and no format of files. Still, whatever
//! the bytes are, reading them gives an error and never a panic, and takes no more memory than they say.

mod commands;
mod messages;
mod pictures;
mod reports;
mod scenes;
mod shared;
mod values;

#[cfg(test)]
mod tests;

use sprung::{Code, Error, Result};
use sprung_io::{Pack, Unpack};

pub(crate) use messages::{Fingerprint, FromHost, ToHost};
pub(crate) use reports::{Reader, Writer};
pub(crate) use scenes::Start;

/// Something that goes over the wire by itself.
pub(crate) trait Wire: Sized {
    /// Puts it behind what is there.
    fn write(&self, pack: &mut Pack);

    /// Takes it off the front.
    ///
    /// # Errors
    /// [`Code::Unreadable`], or what else is wrong with it.
    fn read(read: &mut Unpack<'_>) -> Result<Self>;

    /// It alone as bytes.
    fn to_bytes(&self) -> Vec<u8> {
        let mut pack = Pack::new();
        self.write(&mut pack);
        pack.into_bytes()
    }

    /// It from bytes of which it is all.
    ///
    /// # Errors
    /// As [`read`](Self::read), and if something is left.
    fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let mut read = Unpack::new(bytes);
        let value = Self::read(&mut read)?;
        read.end().map(|()| value)
    }
}

pub(crate) fn damaged(what: &str) -> Error {
    Error::new(Code::Unreadable, format!("a message between page and worker {what}"))
}

/// Structs whose fields go one after another.
macro_rules! structs {
    ($($name:ty { $($field:ident),+ $(,)? })+) => {$(
        impl crate::wire::Wire for $name {
            fn write(&self, pack: &mut sprung_io::Pack) {
                let Self { $($field),+ } = self;
                $($field.write(pack);)+
            }

            fn read(read: &mut sprung_io::Unpack<'_>) -> sprung::Result<Self> {
                Ok(Self { $($field: crate::wire::Wire::read(read)?),+ })
            }
        }
    )+};
}

/// Enums: a number for the variant, and what it holds.
macro_rules! enums {
    ($($name:ty { $($number:literal $variant:ident $(($($field:ident),+))?),+ $(,)? })+) => {$(
        impl crate::wire::Wire for $name {
            fn write(&self, pack: &mut sprung_io::Pack) {
                match self {
                    $(Self::$variant $(($($field),+))? => {
                        pack.u8($number);
                        $($($field.write(pack);)+)?
                    })+
                }
            }

            fn read(read: &mut sprung_io::Unpack<'_>) -> sprung::Result<Self> {
                Ok(match read.u8()? {
                    $($number => Self::$variant $(($({
                        let $field = crate::wire::Wire::read(read)?;
                        $field
                    }),+))?,)+
                    _ => return Err(crate::wire::damaged("names something that there is not")),
                })
            }
        }
    )+};
}

pub(crate) use {enums, structs};
