//! What is kept of a USD layer: prims with their types and the values of their properties.

use std::collections::BTreeMap;

/// A value, as far as meshes need it: numbers of all kinds one after the other.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    Numbers(Vec<f64>),
    Words(Vec<String>),
}

/// Something with a name in the tree of a scene.
#[derive(Clone, Debug, Default)]
pub(super) struct Prim {
    pub name: String,
    /// `Mesh`, `Xform` and the like.
    pub kind: String,
    /// Which of the prims it lies in; none for those at the top.
    pub parent: Option<usize>,
    pub values: BTreeMap<String, Value>,
    /// Whether it refers to other layers or prims.
    pub refers: bool,
}

impl Prim {
    pub fn numbers(&self, name: &str) -> Option<&[f64]> {
        match self.values.get(name) {
            Some(Value::Numbers(numbers)) => Some(numbers),
            _ => None,
        }
    }

    pub fn words(&self, name: &str) -> Option<&[String]> {
        match self.values.get(name) {
            Some(Value::Words(words)) => Some(words),
            _ => None,
        }
    }
}

/// A layer. Prims come after those that they lie in.
#[derive(Clone, Debug, Default)]
pub(super) struct Layer {
    /// `metersPerUnit`; that of USD is 0.01 where nothing is said.
    pub metres: Option<f64>,
    /// `upAxis`; that of USD is Y where nothing is said.
    pub up: Option<String>,
    pub prims: Vec<Prim>,
}
