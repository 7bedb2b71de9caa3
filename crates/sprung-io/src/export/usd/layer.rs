//! What a USD layer holds, whatever it is written as: prims with attributes, some of which are sampled frame by frame.

/// The value of an attribute.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Bool(bool),
    Token(&'static str),
    Ints(Vec<i32>),
    Floats(Vec<f32>),
    Vec3s(Vec<[f32; 3]>),
    /// One array of vectors for each frame: this column of them.
    Samples(usize),
}

/// An attribute of a prim.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    pub name: &'static str,
    /// Its type as USD names it, such as `point3f[]`.
    pub type_name: &'static str,
    /// Said to be the same at all times.
    pub uniform: bool,
    /// How its elements belong to points and faces, where USD asks.
    pub interpolation: Option<&'static str>,
    pub value: Value,
}

impl Attribute {
    /// An attribute of which one value holds at all times.
    pub fn uniform(name: &'static str, type_name: &'static str, value: Value) -> Self {
        Self { name, type_name, uniform: true, interpolation: None, value }
    }

    /// An attribute whose value may differ from time to time.
    pub fn varying(name: &'static str, type_name: &'static str, value: Value) -> Self {
        Self { name, type_name, uniform: false, interpolation: None, value }
    }

    /// With elements that belong to points (`vertex`) or to the whole (`constant`).
    pub fn interpolated(mut self, interpolation: &'static str) -> Self {
        self.interpolation = Some(interpolation);
        self
    }
}

/// A prim: a thing in the scene, with those below it.
#[derive(Clone, Debug, PartialEq)]
pub struct Prim {
    /// An identifier, unlike those of its siblings.
    pub name: String,
    /// Its schema, such as `Mesh`.
    pub type_name: &'static str,
    /// What it is called for people.
    pub display_name: String,
    pub attributes: Vec<Attribute>,
    pub children: Vec<Prim>,
}

/// A layer with one root prim, which is its default prim.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// A sentence on where it comes from.
    pub documentation: String,
    /// `Y` or `Z`.
    pub up_axis: &'static str,
    pub metres_per_unit: f64,
    /// Frames, and so time codes, in a second.
    pub rate: f64,
    pub root: Prim,
    /// How many vectors each column of a frame has.
    pub columns: Vec<usize>,
}

/// The frames of a layer: their numbers are its time codes, one after the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    pub first: u64,
    pub count: u64,
}

impl Span {
    /// The last frame's number; the first's where there is none.
    pub fn last(self) -> u64 {
        self.first + self.count.saturating_sub(1)
    }

    /// The number of the frame that must follow, once there is one.
    pub fn next(self) -> Option<u64> {
        (self.count > 0).then(|| self.first + self.count)
    }
}

/// A name as USD allows it: ASCII letters, digits and `_`, not a digit first, and unlike those in `taken`.
///
/// USD has since come to allow letters of all scripts, but many readers have not.
pub fn identifier(name: &str, taken: &[String]) -> String {
    let clean = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let mut base: String = name.chars().map(clean).collect();
    if base.is_empty() || base.starts_with(|c: char| c.is_ascii_digit()) {
        base.insert(0, '_');
    }
    let mut candidate = base.clone();
    let mut number = 1;
    while taken.contains(&candidate) {
        number += 1;
        candidate = format!("{base}_{number}");
    }
    candidate
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_identifiers_unlike_each_other() {
        let mut taken = Vec::new();
        for (name, expected) in [
            ("left post", "left_post"),
            ("left-post", "left_post_2"),
            ("left_post_2", "left_post_2_2"),
            ("2nd", "_2nd"),
            ("", "_"),
            ("Würfel", "W_rfel"),
        ] {
            let found = identifier(name, &taken);
            assert_eq!(found, expected);
            taken.push(found);
        }
    }
}
