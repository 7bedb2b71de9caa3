//! Binary USD (`.usdc`, versions 0.4 to 0.x): tables of words, fields and paths, and values at their places in the file.

use std::cell::Cell;
use std::collections::HashMap;

use sprung::{Code, Error, Result};

use super::layer::{Layer, Prim, Value};
use super::lz4;
use crate::import::bytes::{Bytes, Order};
use crate::import::malformed;

/// Entries that a table may have.
const MOST: u64 = 1 << 24;
/// Words in one list, such as that of a prim's transforms.
const MOST_WORDS: u64 = 1000;
/// The type of a prim's spec, and that of an attribute.
const PRIM: i32 = 6;
const ATTRIBUTE: i32 = 1;

struct Crate<'a> {
    bytes: &'a [u8],
    version: u8,
    tokens: Vec<String>,
    /// A name and what stands for a value.
    fields: Vec<(usize, u64)>,
    sets: Vec<u32>,
    /// Numbers that may still be read: many attributes may share one place in the file.
    budget: Cell<u64>,
}

pub(super) fn read(bytes: &[u8]) -> Result<Layer> {
    let mut head = Bytes::new(bytes, Order::Little);
    if head.take(8)? != b"PXR-USDC" {
        return Err(malformed("does not begin with PXR-USDC; is it a binary USD file?"));
    }
    let version = head.take(8)?;
    if version[0] != 0 || version[1] < 4 {
        let sentence =
            format!("is binary USD of version {}.{}, and 0.4 and later are read", version[0], version[1]);
        return Err(Error::new(Code::Unsupported, sentence));
    }
    let version = version[1];
    let mut contents = from(bytes, head.u64()?)?;
    let count = contents.u64()?;
    let count = contents.check_count(count, 32, "sections")?;
    let mut sections = HashMap::new();
    for _ in 0..count {
        let name = contents.take(16)?;
        let name: Vec<u8> = name.iter().copied().take_while(|&byte| byte != 0).collect();
        let (start, size) = (contents.u64()?, contents.u64()?);
        let end = start.checked_add(size).filter(|&end| end <= bytes.len() as u64);
        let end = end.ok_or_else(|| malformed("has a section that reaches beyond its end"))?;
        sections.insert(name, &bytes[start as usize..end as usize]);
    }
    let section = |name: &str| {
        let found = sections.get(name.as_bytes()).copied();
        found
            .map(|bytes| Bytes::new(bytes, Order::Little))
            .ok_or_else(|| malformed(format!("has no section {name}")))
    };
    let mut file = Crate {
        bytes,
        version,
        tokens: Vec::new(),
        fields: Vec::new(),
        sets: Vec::new(),
        budget: Cell::new(super::budget(bytes)),
    };
    file.read_tokens(&mut section("TOKENS")?)?;
    file.read_fields(&mut section("FIELDS")?)?;
    let mut sets = section("FIELDSETS")?;
    let count = table_size(&mut sets)?;
    file.sets = packed(&mut sets, count)?.into_iter().map(|index| index as u32).collect();
    let paths = read_paths(&mut section("PATHS")?, &file.tokens)?;
    file.layer(&paths, &mut section("SPECS")?)
}

/// The bytes from a place on.
fn from(bytes: &[u8], place: u64) -> Result<Bytes<'_>> {
    let rest = usize::try_from(place).ok().and_then(|place| bytes.get(place..));
    rest.map(|rest| Bytes::new(rest, Order::Little)).ok_or_else(|| malformed("names a place beyond its end"))
}

fn table_size(bytes: &mut Bytes<'_>) -> Result<usize> {
    let count = bytes.u64()?;
    if count > MOST {
        return Err(Error::new(Code::TooLarge, format!("says that it has {count} entries in a table")));
    }
    Ok(count as usize)
}

/// Whole numbers that are compressed, after the size of that.
fn packed(bytes: &mut Bytes<'_>, count: usize) -> Result<Vec<i32>> {
    let size = bytes.u64()?;
    let size = bytes.check_count(size, 1, "bytes")?;
    lz4::integers(bytes.take(size)?, count)
}

/// One path: what it lies in, its last name, and whether it is a property.
struct Place {
    parent: Option<usize>,
    name: usize,
    is_property: bool,
}

/// The paths by their numbers. They come as a tree: after each its children, and how far it is to its sibling.
fn read_paths(bytes: &mut Bytes<'_>, tokens: &[String]) -> Result<Vec<Option<Place>>> {
    let all = table_size(bytes)?;
    let count = table_size(bytes)?;
    let numbers = packed(bytes, count)?;
    let names = packed(bytes, count)?;
    let jumps = packed(bytes, count)?;
    // Every number of a path has one, but for those that were deleted.
    if count > all || all > 2 * count + 1000 {
        return Err(malformed(format!("says that it has {all} paths, and has {count}")));
    }
    let mut places: Vec<Option<Place>> = (0..all).map(|_| None).collect();
    let mut waiting: Vec<(usize, Option<usize>)> = if count > 0 { vec![(0, None)] } else { Vec::new() };
    let mut visits = 0;
    while let Some((mut at, mut parent)) = waiting.pop() {
        loop {
            visits += 1;
            let (Some(&number), Some(&name), Some(&jump)) = (numbers.get(at), names.get(at), jumps.get(at))
            else {
                return Err(malformed("has a path beyond its table"));
            };
            let slot = usize::try_from(number).ok().and_then(|number| places.get_mut(number));
            let Some(slot) = slot.filter(|slot| slot.is_none()) else {
                return Err(malformed("has a path twice, or beyond its table"));
            };
            if visits > count || (visits > 1 && name.unsigned_abs() as usize >= tokens.len()) {
                return Err(malformed("has paths that lie within each other"));
            }
            *slot = Some(Place { parent, name: name.unsigned_abs() as usize, is_property: name < 0 });
            let (has_child, has_sibling) = (jump > 0 || jump == -1, jump >= 0);
            if has_child {
                if has_sibling {
                    waiting.push((at + jump as usize, parent));
                }
                parent = Some(number as usize);
            } else if !has_sibling {
                break;
            }
            at += 1;
        }
    }
    Ok(places)
}

impl Crate<'_> {
    fn read_tokens(&mut self, bytes: &mut Bytes<'_>) -> Result<()> {
        let count = table_size(bytes)?;
        let (size, packed) = (bytes.u64()?, bytes.u64()?);
        let packed = bytes.check_count(packed, 1, "bytes")?;
        let text = lz4::decompressed(bytes.take(packed)?, usize::try_from(size).unwrap_or(usize::MAX))?;
        let words = text.split(|&byte| byte == 0).take(count);
        self.tokens = words.map(super::shortened).collect();
        if self.tokens.len() == count { Ok(()) } else { Err(malformed("has fewer words than it says")) }
    }

    fn read_fields(&mut self, bytes: &mut Bytes<'_>) -> Result<()> {
        let count = table_size(bytes)?;
        let names = packed(bytes, count)?;
        let size = bytes.u64()?;
        let size = bytes.check_count(size, 1, "bytes")?;
        let values = lz4::decompressed(bytes.take(size)?, 8 * count)?;
        let mut values = Bytes::new(&values, Order::Little);
        for name in names {
            self.fields.push((name as usize, values.u64()?));
        }
        Ok(())
    }

    fn layer(&self, places: &[Option<Place>], bytes: &mut Bytes<'_>) -> Result<Layer> {
        let count = table_size(bytes)?;
        let [paths, sets, kinds] = [packed(bytes, count)?, packed(bytes, count)?, packed(bytes, count)?];
        let mut spec_of: HashMap<usize, (i32, usize)> = HashMap::new();
        for ((&path, &set), &kind) in paths.iter().zip(&sets).zip(&kinds) {
            spec_of.insert(path as usize, (kind, set as usize));
        }
        let mut layer = Layer::default();
        let mut prim_of: HashMap<usize, usize> = HashMap::new();
        // Parents before children, in the order of the file: by depth first, and a path's number is no help there.
        let mut order: Vec<usize> = (0..places.len()).filter(|&path| places[path].is_some()).collect();
        let depth = |path: usize| {
            let up = |&path: &usize| places.get(path).and_then(Option::as_ref).and_then(|place| place.parent);
            std::iter::successors(Some(path), up).count()
        };
        order.sort_by_cached_key(|&path| (depth(path), path));
        for path in order {
            let (Some(place), Some(&(kind, set))) = (&places[path], spec_of.get(&path)) else { continue };
            let fields = self.fields_of(set);
            let value = |name: &str| fields.iter().find(|(field, _)| *field == name).map(|&(_, value)| value);
            if place.parent.is_none() {
                let wrong =
                    |name: &str, what: &str| Error::new(Code::WrongType, what).at_field(name.to_owned());
                if let Some(rep) = value("metersPerUnit") {
                    let number = self.number(rep);
                    layer.metres = Some(
                        number
                            .ok_or_else(|| wrong("metersPerUnit", "is no number of a kind that is read"))?,
                    );
                }
                if let Some(rep) = value("upAxis") {
                    let word = self.word(rep);
                    layer.up =
                        Some(word.ok_or_else(|| wrong("upAxis", "is no word, and must be \"Y\" or \"Z\""))?);
                }
            } else if kind == PRIM && !place.is_property {
                let prim = Prim {
                    name: self.tokens[place.name].clone(),
                    kind: value("typeName").and_then(|rep| self.word(rep)).unwrap_or_default(),
                    parent: place.parent.and_then(|parent| prim_of.get(&parent)).copied(),
                    refers: ["references", "payload", "inheritPaths", "specializes"]
                        .iter()
                        .any(|name| value(name).is_some()),
                    ..Prim::default()
                };
                prim_of.insert(path, layer.prims.len());
                layer.prims.push(prim);
            } else if kind == ATTRIBUTE && place.is_property {
                let Some(&prim) = place.parent.and_then(|parent| prim_of.get(&parent)) else { continue };
                let name = &self.tokens[place.name];
                if !super::is_wanted(name) {
                    continue;
                }
                if let Some(rep) = value("default")
                    && let Some(value) = self.value(rep)?
                {
                    layer.prims[prim].values.insert(name.clone(), value);
                }
            }
        }
        Ok(layer)
    }

    /// The fields of a set, by name.
    fn fields_of(&self, set: usize) -> Vec<(&str, u64)> {
        let indices =
            self.sets.get(set..).unwrap_or_default().iter().take_while(|&&index| index != u32::MAX).take(256);
        let found = indices.filter_map(|&index| self.fields.get(index as usize));
        found.filter_map(|&(name, value)| Some((self.tokens.get(name)?.as_str(), value))).collect()
    }

    fn number(&self, rep: u64) -> Option<f64> {
        match self.value(rep) {
            Ok(Some(Value::Numbers(numbers))) => numbers.first().copied(),
            _ => None,
        }
    }

    fn word(&self, rep: u64) -> Option<String> {
        match self.value(rep) {
            Ok(Some(Value::Words(words))) => words.into_iter().next(),
            _ => None,
        }
    }

    /// A value; none of a type that meshes have no use for.
    fn value(&self, rep: u64) -> Result<Option<Value>> {
        let (is_array, is_inline, is_packed) = (rep >> 63 & 1 == 1, rep >> 62 & 1 == 1, rep >> 61 & 1 == 1);
        let (kind, payload) = (rep >> 48 & 0xff, rep & 0xffff_ffff_ffff);
        // Type of a number, and how many make one value.
        let (number, width) = match kind {
            3 | 4 => (Number::I32, 1),
            8 => (Number::F32, 1),
            9 => (Number::F64, 1),
            11 => (Number::Token, 1),
            15 => (Number::F64, 16),
            16 => (Number::F64, 4),
            17 => (Number::F32, 4),
            23 => (Number::F64, 3),
            24 => (Number::F32, 3),
            _ => return Ok(None),
        };
        if is_inline && !is_array {
            let low = payload as u32;
            let bytes = low.to_le_bytes().map(|byte| f64::from(byte as i8));
            return Ok(match (kind, number) {
                (_, Number::Token) => {
                    self.tokens.get(low as usize).map(|word| Value::Words(vec![word.clone()]))
                }
                (3 | 4, _) => Some(Value::Numbers(vec![f64::from(low as i32)])),
                (8 | 9, _) => Some(Value::Numbers(vec![f64::from(f32::from_bits(low))])),
                (23 | 24, _) => Some(Value::Numbers(bytes[..3].to_vec())),
                // The diagonal of a matrix that has nothing else.
                (15, _) => Some(Value::Numbers(
                    (0..16).map(|k| if k % 5 == 0 { bytes[k / 5] } else { 0.0 }).collect(),
                )),
                _ => None,
            });
        }
        if is_array && payload == 0 {
            return Ok(Some(if number == Number::Token {
                Value::Words(Vec::new())
            } else {
                Value::Numbers(Vec::new())
            }));
        }
        let mut bytes = from(self.bytes, payload)?;
        let mut count = 1;
        if is_array {
            if self.version < 5 {
                bytes.u32()?;
            }
            count = if self.version >= 7 { bytes.u64()? } else { u64::from(bytes.u32()?) };
        }
        let left = self.budget.get().checked_sub(count.saturating_mul(width as u64));
        let left = left.filter(|_| number != Number::Token || count <= MOST_WORDS);
        self.budget.set(left.ok_or_else(|| Error::new(Code::TooLarge, "would be far larger than its file"))?);
        if is_packed && count >= 16 {
            if number != Number::I32 || count > MOST {
                let sentence = "has compressed numbers of a kind that is not read";
                return Err(Error::new(Code::Unsupported, sentence)
                    .with_fix("export it as .usda, or as another format"));
            }
            let values = packed(&mut bytes, count as usize)?;
            return Ok(Some(Value::Numbers(values.into_iter().map(f64::from).collect())));
        }
        let each = width as u64 * if number == Number::F64 { 8 } else { 4 };
        let count = bytes.check_count(count, each, "values")? * width;
        if number == Number::Token {
            let mut words = Vec::with_capacity(count);
            for _ in 0..count {
                let index = bytes.u32()? as usize;
                words.push(
                    self.tokens
                        .get(index)
                        .cloned()
                        .ok_or_else(|| malformed("names a word that is not there"))?,
                );
            }
            return Ok(Some(Value::Words(words)));
        }
        let mut numbers = Vec::with_capacity(count);
        for _ in 0..count {
            numbers.push(match number {
                Number::I32 => f64::from(bytes.i32()?),
                Number::F32 => f64::from(bytes.f32()?),
                _ => bytes.f64()?,
            });
        }
        Ok(Some(Value::Numbers(numbers)))
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Number {
    I32,
    F32,
    F64,
    Token,
}
