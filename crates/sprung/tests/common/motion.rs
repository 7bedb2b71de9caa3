//! The engine, the plain float32 loop and the float64 twin behind one face, so that one test measures all three.

use super::plain::Plain;
use super::twin::{Ground, Point, Spring, Twin, V3, scale};
use sprung::solver::SymplecticEuler;
use sprung::{DVec3, Inline, Model, Params, State, Vec3};

/// A network that moves.
pub trait Motion {
    /// Takes `count` steps of length dt.
    fn steps(&mut self, dt: f64, count: u64);
    /// Multiplies every velocity.
    fn slow_down(&mut self, by: f64);
    /// Where the points are, with whatever is kept of what rounding dropped, m.
    fn places(&self) -> Vec<V3>;
    /// Where a reader of the positions alone sees them, m.
    fn seen(&self) -> Vec<V3> {
        self.places()
    }
}

/// The engine's solver with its parameters and state.
pub struct Ours {
    solver: SymplecticEuler,
    params: Params,
    state: State,
}

impl Ours {
    pub fn new(model: &Model, params: &Params, state: &State) -> Self {
        let solver = SymplecticEuler::new(model.clone(), params);
        Self { solver, params: params.clone(), state: state.clone() }
    }
}

impl Motion for Ours {
    fn steps(&mut self, dt: f64, count: u64) {
        self.params.dt = dt;
        self.solver.load(&self.state);
        let (_, finite) = self.solver.advance(&self.params, count, &Inline);
        assert!(finite, "it blew up");
        self.solver.store(&mut self.state);
    }

    fn slow_down(&mut self, by: f64) {
        let State { velocity, velocity_low, .. } = &mut self.state;
        for (high, low) in velocity.iter_mut().zip(velocity_low) {
            let slower = (high.as_dvec3() + low.as_dvec3()) * by;
            *high = slower.as_vec3();
            *low = (slower - high.as_dvec3()).as_vec3();
        }
    }

    fn places(&self) -> Vec<V3> {
        (0..self.state.position.len()).map(|point| super::position(&self.state, point).to_array()).collect()
    }

    fn seen(&self) -> Vec<V3> {
        self.state.position.iter().map(|x| x.as_dvec3().to_array()).collect()
    }
}

impl Motion for Plain {
    fn steps(&mut self, dt: f64, count: u64) {
        (0..count).for_each(|_| self.step(dt as f32));
    }

    fn slow_down(&mut self, by: f64) {
        self.velocity.iter_mut().for_each(|v| *v *= by as f32);
    }

    fn places(&self) -> Vec<V3> {
        self.position.iter().map(|x| x.as_dvec3().to_array()).collect()
    }
}

impl Motion for Twin {
    /// With dt as a float32, as the others have it: what is put in is not what is compared.
    fn steps(&mut self, dt: f64, count: u64) {
        (0..count).for_each(|_| self.step(f64::from(dt as f32)));
    }

    fn slow_down(&mut self, by: f64) {
        self.points.iter_mut().for_each(|point| point.v = scale(point.v, by));
    }

    fn places(&self) -> Vec<V3> {
        self.points.iter().map(|point| point.x).collect()
    }
}

/// The twin of these parts, from the same float32 numbers.
pub fn twin_of(model: &Model, params: &Params, state: &State) -> Twin {
    let point = |at: usize| Point {
        m: if params.is_fixed(at) { 0.0 } else { f64::from(params.point_mass[at]) },
        x: super::position(state, at).to_array(),
        v: if params.is_fixed(at) { [0.0; 3] } else { super::velocity(state, at).to_array() },
        f: [0.0; 3],
    };
    let spring = |(at, &[i, j]): (usize, &[u32; 2])| Spring {
        i: i as usize,
        j: j as usize,
        ks: f64::from(params.spring_stiffness[at]),
        kd: f64::from(params.spring_damping[at]),
        rest: f64::from(params.spring_rest_length[at]),
    };
    let ground = params.planes.first().map(|plane| Ground {
        y: f64::from(plane.point.y),
        kc: f64::from(plane.stiffness),
        kcd: f64::from(plane.damping),
    });
    Twin {
        points: (0..model.point_count()).map(point).collect(),
        springs: model.springs().iter().enumerate().map(spring).collect(),
        ground,
        g: -f64::from(params.gravity.y),
    }
}

/// A state with these positions, at rest.
pub fn at_rest(places: &[V3]) -> State {
    let exact = |place: &V3| DVec3::from_array(*place);
    let position: Vec<_> = places.iter().map(|place| exact(place).as_vec3()).collect();
    let dropped = |(place, high): (&V3, &Vec3)| (exact(place) - high.as_dvec3()).as_vec3();
    let low = places.iter().zip(&position).map(dropped).collect();
    let velocity = vec![Vec3::ZERO; places.len()];
    let mut state = State::new(position, velocity);
    state.position_low = low;
    state
}

/// Gives every point that can move a random velocity, up to `speed` along each axis (m/s).
pub fn stir(params: &Params, state: &mut State, mut seed: u32, speed: f32) {
    for (point, velocity) in state.velocity.iter_mut().enumerate() {
        if params.is_fixed(point) {
            continue;
        }
        for component in velocity.as_mut() {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *component += speed * ((seed >> 8) as f32 / (1 << 23) as f32 - 1.0);
        }
    }
}
