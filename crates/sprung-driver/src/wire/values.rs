//! Small values: numbers, texts, what may be there or not, lists; the engine's changes, energies, limits and errors.

use std::ops::Range;
use std::sync::Arc;

use sprung::energy::LedgerSums;
use sprung::stability::{Limit, Setter};
use sprung::{
    BlowUp, Cause, Change, Code, ContactLaw, Energy, Error, Grab, Params, Place, Plane, Result,
    SettleOptions, Vec3,
};
use sprung_io::{Pack, Unpack};

use super::{Wire, damaged, enums, structs};

/// What bytes have a name for already.
macro_rules! plain {
    ($($type:ty: $name:ident)+) => {$(
        impl Wire for $type {
            fn write(&self, pack: &mut Pack) {
                pack.$name(*self);
            }

            fn read(read: &mut Unpack<'_>) -> Result<Self> {
                read.$name()
            }
        }
    )+};
}

plain! { u32: u32 u64: u64 f32: f32 f64: f64 Vec3: vec3 }

impl Wire for usize {
    fn write(&self, pack: &mut Pack) {
        pack.u64(*self as u64);
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        Self::try_from(read.u64()?).map_err(|_| damaged("has a number that is too large"))
    }
}

impl Wire for bool {
    fn write(&self, pack: &mut Pack) {
        pack.u8((*self).into());
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        read.bool()
    }
}

impl Wire for String {
    fn write(&self, pack: &mut Pack) {
        pack.text(self);
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        read.text().map(str::to_owned)
    }
}

impl<T: Wire> Wire for Option<T> {
    fn write(&self, pack: &mut Pack) {
        self.is_some().write(pack);
        if let Some(value) = self {
            value.write(pack);
        }
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        if bool::read(read)? { T::read(read).map(Some) } else { Ok(None) }
    }
}

impl<T: Wire> Wire for Vec<T> {
    fn write(&self, pack: &mut Pack) {
        self.len().write(pack);
        self.iter().for_each(|value| value.write(pack));
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        // Collected one by one: a count is no reason to take memory.
        (0..u64::read(read)?).map(|_| T::read(read)).collect()
    }
}

impl<T: Wire> Wire for Box<T> {
    fn write(&self, pack: &mut Pack) {
        (**self).write(pack);
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        T::read(read).map(Self::new)
    }
}

impl<A: Wire, B: Wire> Wire for (A, B) {
    fn write(&self, pack: &mut Pack) {
        self.0.write(pack);
        self.1.write(pack);
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        Ok((A::read(read)?, B::read(read)?))
    }
}

impl<A: Wire, B: Wire, C: Wire> Wire for (A, B, C) {
    fn write(&self, pack: &mut Pack) {
        self.0.write(pack);
        self.1.write(pack);
        self.2.write(pack);
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        Ok((A::read(read)?, B::read(read)?, C::read(read)?))
    }
}

impl<T: Wire> Wire for Range<T> {
    fn write(&self, pack: &mut Pack) {
        self.start.write(pack);
        self.end.write(pack);
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        Ok(T::read(read)?..T::read(read)?)
    }
}

impl Wire for Arc<Params> {
    fn write(&self, pack: &mut Pack) {
        pack.params(self);
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        read.params().map(Self::new)
    }
}

structs! {
    Grab { point, target, stiffness, damping }
    Plane { point, normal, stiffness, damping, law }
    SettleOptions { residual_force, max_steps }
    LedgerSums { start, work_in, lost_in_dampers, lost_in_contact, integrator_error, suspect_steps }
    Energy { kinetic, gravitational, elastic, contact, sums }
    Limit { dt, setter }
    Place { file, line_column, field }
    BlowUp {
        cause,
        step,
        time,
        good_step,
        good_time,
        spring,
        points,
        owner,
        place,
        dt,
        damping_scale,
        dt_limit_certified,
        dt_limit_every_configuration,
    }
}

enums! {
    ContactLaw { 0 Push, 1 Report }
    Setter { 0 Spring(index), 1 Point(index) }
    Change {
        0 Dt(dt),
        1 Substeps(count),
        2 Gravity(gravity),
        3 Planes(planes),
        4 Mass(points, mass),
        5 Pin(points, on),
        6 Stiffness(springs, stiffness),
        7 Damping(springs, damping),
        8 RestScale(springs, scale),
        9 Cut(springs, on),
        10 Force(point, force),
        11 Grab(grab),
        12 Release(point),
        13 Carry(point, velocity),
        14 Place(point, position),
        15 Params(params),
    }
}

impl Wire for Cause {
    fn write(&self, pack: &mut Pack) {
        let excess = match *self {
            Self::NotFinite => None,
            Self::EnergyFromNowhere { excess } => Some(excess),
        };
        excess.write(pack);
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        Ok(Option::read(read)?.map_or(Self::NotFinite, |excess| Self::EnergyFromNowhere { excess }))
    }
}

impl Wire for Code {
    fn write(&self, pack: &mut Pack) {
        pack.u8(*self as u8);
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        let code = Self::ALL.get(usize::from(read.u8()?));
        code.copied().ok_or_else(|| damaged("has a code that there is not"))
    }
}

impl Wire for Error {
    fn write(&self, pack: &mut Pack) {
        self.blow_up().cloned().write(pack);
        if self.blow_up().is_none() {
            self.code().write(pack);
            pack.text(self.sentence());
        }
        self.place().clone().write(pack);
        self.fix().map(str::to_owned).write(pack);
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        let mut error = match Option::read(read)? {
            Some(blow_up) => Self::from_blow_up(blow_up),
            None => Self::new(Code::read(read)?, read.text()?),
        };
        let Place { file, line_column, field } = Place::read(read)?;
        if let Some(file) = file {
            error = error.in_file(file);
        }
        if let Some((line, column)) = line_column {
            error = error.at_line(line, column);
        }
        if let Some(field) = field {
            error = error.at_field(field);
        }
        Ok(match Option::<String>::read(read)? {
            Some(fix) => error.with_fix(fix),
            None => error,
        })
    }
}
