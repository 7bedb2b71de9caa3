//! Which formula fits a scene: told from what is joined to what, not from its name.

use sprung::{DVec3, Model, Params};

use super::exact::Damped;

/// A scene for which there is a formula.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// One mass on one spring from a fixed point.
    Oscillator(Oscillator),
    /// A row of points, held at one end.
    Chain(Chain),
}

/// One mass on one spring from a fixed point, with its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillator {
    /// The fixed point.
    pub anchor: usize,
    /// The mass.
    pub bob: usize,
    /// kg.
    pub mass: f64,
    /// k_s, N/m.
    pub stiffness: f64,
    /// k_d, N·s/m.
    pub damping: f64,
    /// L, m.
    pub rest_length: f64,
    /// Gravitational acceleration, m/s².
    pub gravity: DVec3,
}

impl Oscillator {
    /// Its motion along the spring, about the length at which it hangs.
    pub fn along(&self) -> Damped {
        Damped { omega: (self.stiffness / self.mass).sqrt(), c: self.damping / self.mass }
    }

    /// Its small swing to the side: ω² = g/ℓ. The damper acts along the spring and does not see it.
    pub fn sideways(&self) -> Damped {
        Damped { omega: (self.gravity.length() / self.length()).sqrt(), c: 0.0 }
    }

    /// The length at which it hangs at rest, m.
    pub fn length(&self) -> f64 {
        super::exact::hanging_length(self.rest_length, self.stiffness, self.mass, self.gravity.length())
    }

    /// Where it hangs, as a direction from the fixed point: along gravity. `None` without gravity.
    pub fn down(&self) -> Option<DVec3> {
        self.gravity.try_normalize()
    }
}

/// A row of points, from the one that is held.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// The springs in order from the fixed end.
    pub springs: Vec<usize>,
    /// The mass at the far end of each, kg.
    pub masses: Vec<f64>,
    /// The stiffness of each, N/m.
    pub stiffness: Vec<f64>,
    /// Gravitational acceleration, m/s².
    pub g: f64,
}

/// Larger chains have bars too thin to see.
const MOST_SPRINGS: usize = 400;

/// The formula that fits, if one does: a single row of springs, all uncut and stiff, from one fixed point, free of planes,
/// pulls and other forces.
pub fn recognise(model: &Model, params: &Params) -> Option<Shape> {
    let (points, springs) = (model.point_count(), model.spring_count());
    let undisturbed = params.planes.is_empty() && params.external_forces.is_empty();
    if springs == 0 || springs > MOST_SPRINGS || points != springs + 1 || !undisturbed {
        return None;
    }
    let mut fixed = (0..points).filter(|&point| params.is_fixed(point));
    let (Some(anchor), None) = (fixed.next(), fixed.next()) else { return None };
    let order = row_from(model, anchor)?;
    let sound =
        |&(spring, _): &(usize, usize)| !params.spring_cut[spring] && params.spring_stiffness[spring] > 0.0;
    if !order.iter().all(sound) {
        return None;
    }
    let gravity = params.gravity.as_dvec3();
    if let [(spring, bob)] = order[..] {
        return Some(Shape::Oscillator(Oscillator {
            anchor,
            bob,
            mass: f64::from(params.point_mass[bob]),
            stiffness: f64::from(params.spring_stiffness[spring]),
            damping: f64::from(params.spring_damping[spring]),
            rest_length: f64::from(params.spring_rest_length[spring]),
            gravity,
        }));
    }
    Some(Shape::Chain(Chain {
        springs: order.iter().map(|&(spring, _)| spring).collect(),
        masses: order.iter().map(|&(_, point)| f64::from(params.point_mass[point])).collect(),
        stiffness: order.iter().map(|&(spring, _)| f64::from(params.spring_stiffness[spring])).collect(),
        g: gravity.length(),
    }))
}

/// Walks from a point along springs that do not branch: each spring, with the point at its far end.
fn row_from(model: &Model, anchor: usize) -> Option<Vec<(usize, usize)>> {
    let mut order = Vec::with_capacity(model.spring_count());
    let mut here = anchor;
    while order.len() < model.spring_count() {
        let last = order.last().map(|&(spring, _)| spring);
        let onward =
            |spring: &usize| Some(*spring) != last && model.springs()[*spring].contains(&(here as u32));
        let mut springs = (0..model.spring_count()).filter(onward);
        let (Some(spring), None) = (springs.next(), springs.next()) else { return None };
        let [i, j] = model.springs()[spring].map(|end| end as usize);
        here = if i == here { j } else { i };
        order.push((spring, here));
    }
    Some(order)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::scene::{BUILTIN, Kind, Scene};

    #[test]
    fn two_of_the_built_in_scenes_have_a_formula() {
        for builtin in BUILTIN.iter().filter(|builtin| builtin.kind != Kind::Benchmark) {
            let (model, params, _) =
                Scene::builtin(builtin.name).expect("it is there").build().expect("it builds");
            let found = match recognise(&model, &params) {
                Some(Shape::Oscillator(_)) => "spring",
                Some(Shape::Chain(chain)) => {
                    assert_eq!(chain.springs, (0..14).collect::<Vec<_>>());
                    "chain"
                }
                None => "",
            };
            let expected = if ["spring", "chain"].contains(&builtin.name) { builtin.name } else { "" };
            assert_eq!(found, expected, "{}", builtin.name);
        }
    }

    #[test]
    fn what_disturbs_takes_the_formula_away() {
        let (model, params, _) = Scene::builtin("chain").expect("it is there").build().expect("it builds");
        let with = |change| {
            let mut params = params.clone();
            params.apply(&model, &change).expect("an allowed change");
            recognise(&model, &params)
        };
        use sprung::Change;
        assert!(with(Change::Dt(0.001)).is_some());
        assert_eq!(with(Change::Cut(3..4, true)), None);
        assert_eq!(with(Change::Pin(14..15, true)), None);
        assert_eq!(with(Change::Stiffness(0..14, 0.0)), None);
        assert_eq!(with(Change::Force(2, sprung::Vec3::X)), None);
    }
}
