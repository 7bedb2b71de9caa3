//! What both ends hold already is named, and not sent again.

use std::sync::Arc;

use sprung::Result;
use sprung_io::{Pack, Unpack};

use super::{Wire, damaged};

/// In place of a number in the list of what is known.
const NEW: u8 = u8::MAX;

/// Says which one of those that are known it is. Gives whether it is none of them, and what it holds has to follow.
pub(super) fn write_known<T>(
    pack: &mut Pack,
    value: &Arc<T>,
    known: &[&Arc<T>],
    is_same: impl Fn(&T, &T) -> bool,
) -> bool {
    let place = known.iter().position(|known| Arc::ptr_eq(known, value));
    let place = place.or_else(|| known.iter().position(|known| is_same(known, value)));
    pack.u8(place.map_or(NEW, |place| place as u8));
    place.is_none()
}

/// As [`write_known`], by what it holds.
pub(super) fn read_known<'a, T>(
    read: &mut Unpack<'a>,
    known: &[&Arc<T>],
    new: impl FnOnce(&mut Unpack<'a>) -> Result<T>,
) -> Result<Arc<T>> {
    match read.u8()? {
        NEW => new(read).map(Arc::new),
        place => {
            let known = known.get(usize::from(place)).ok_or_else(|| damaged("names what is not there"))?;
            Ok(Arc::clone(known))
        }
    }
}

/// Never the same, but for the very same.
pub(super) fn never<T>(_: &T, _: &T) -> bool {
    false
}

/// A list that mostly grows: how many it begins with that are known, and the rest.
pub(super) fn write_grown<T: Wire + PartialEq>(pack: &mut Pack, list: &Arc<Vec<T>>, known: &Arc<Vec<T>>) {
    let kept = if Arc::ptr_eq(list, known) {
        list.len()
    } else {
        list.iter().zip(&**known).take_while(|(new, old)| new == old).count()
    };
    let is_all = kept == list.len() && kept == known.len();
    is_all.write(pack);
    if !is_all {
        kept.write(pack);
        (list.len() - kept).write(pack);
        list[kept..].iter().for_each(|value| value.write(pack));
    }
}

/// As [`write_grown`].
pub(super) fn read_grown<T: Wire + Clone>(read: &mut Unpack<'_>, known: &Arc<Vec<T>>) -> Result<Arc<Vec<T>>> {
    if bool::read(read)? {
        return Ok(known.clone());
    }
    let kept = known.get(..usize::read(read)?).ok_or_else(|| damaged("keeps more than is there"))?;
    let mut list = kept.to_vec();
    list.extend(Vec::read(read)?);
    Ok(Arc::new(list))
}
