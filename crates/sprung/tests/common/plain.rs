//! The step as one writes it in float32 on the first day: the twin's loops, and nothing kept of what rounding drops.
//! What the engine's accuracy is measured against.

use sprung::{Model, Params, State, Vec3};

/// A network in float32.
#[derive(Clone)]
pub struct Plain {
    pub position: Vec<Vec3>,
    pub velocity: Vec<Vec3>,
    springs: Vec<[u32; 2]>,
    params: Params,
}

impl Plain {
    pub fn new(model: &Model, params: &Params, state: &State) -> Self {
        let (position, velocity) = (state.position.clone(), state.velocity.clone());
        Self { position, velocity, springs: model.springs().to_vec(), params: params.clone() }
    }

    pub fn step(&mut self, dt: f32) {
        let mut force = vec![Vec3::ZERO; self.position.len()];
        for (spring, &[i, j]) in self.springs.iter().enumerate() {
            let (i, j) = (i as usize, j as usize);
            let e = self.position[i] - self.position[j];
            let length = e.length();
            if length == 0.0 {
                continue; // no axis
            }
            let u = e / length;
            let stretch = length - self.params.spring_rest_length[spring];
            let speed = (self.velocity[i] - self.velocity[j]).dot(u);
            let pull =
                self.params.spring_stiffness[spring] * stretch + self.params.spring_damping[spring] * speed;
            force[i] -= pull * u;
            force[j] += pull * u;
        }
        for (point, force) in force.into_iter().enumerate() {
            if self.params.is_fixed(point) {
                continue;
            }
            let mass = self.params.point_mass[point];
            let mut force = force + mass * self.params.gravity;
            for plane in &self.params.planes {
                let depth = (plane.point - self.position[point]).dot(plane.normal);
                if depth > 0.0 {
                    let speed = self.velocity[point].dot(plane.normal);
                    force += (plane.stiffness * depth - plane.damping * speed) * plane.normal;
                }
            }
            self.velocity[point] += force / mass * dt;
            self.position[point] += self.velocity[point] * dt;
        }
    }
}
