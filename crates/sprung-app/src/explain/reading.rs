//! The numbers of one step at one spring and one of its points: the engine's readings, as vectors and one step ahead.

use sprung::DVec3;
use sprung_driver::Report;

/// A spring and what it does now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringReading {
    /// Its index.
    pub spring: usize,
    /// What the engine reads off.
    pub now: sprung::SpringReading,
    /// k_s, N/m.
    pub stiffness: f64,
    /// k_d, N·s/m.
    pub damping: f64,
    /// u = (x_i − x_j)/ℓ; zero where both points coincide.
    pub axis: DVec3,
}

impl SpringReading {
    /// −k_s(ℓ − L) u, the force on point i, N.
    pub fn spring_force(&self) -> DVec3 {
        -self.now.spring_force * self.axis
    }

    /// −k_d((v_i − v_j)·u) u, the force on point i, N.
    pub fn damper_force(&self) -> DVec3 {
        -self.now.damper_force * self.axis
    }
}

/// A point, the forces on it, and where the next step takes it.
#[derive(Clone, Debug, PartialEq)]
pub struct PointReading {
    /// Its index.
    pub point: usize,
    /// What the engine reads off.
    pub now: sprung::PointReading,
    /// How many springs pull at it.
    pub spring_count: usize,
    /// Length of the step, s.
    pub dt: f64,
}

impl PointReading {
    /// The force of this name on the point, N; zero if there is none.
    pub fn force(&self, name: &str) -> DVec3 {
        self.now.forces.iter().filter(|(other, _)| *other == name).map(|(_, force)| *force).sum()
    }

    /// (f/m) dt, m/s; zero for a point that is fixed.
    pub fn gain(&self) -> DVec3 {
        if self.now.is_fixed { DVec3::ZERO } else { self.now.total_force / self.now.mass * self.dt }
    }

    /// v + (f/m) dt, m/s.
    pub fn new_velocity(&self) -> DVec3 {
        self.now.velocity + self.gain()
    }

    /// x + v dt with the new v, m.
    pub fn new_position(&self) -> DVec3 {
        self.now.position + self.new_velocity() * self.dt
    }
}

/// What a spring does now; `None` if there is no such spring.
pub fn spring(report: &Report, spring: usize) -> Option<SpringReading> {
    let (model, params) = (&report.opened.model, &report.params);
    let now = sprung::SpringReading::of(model, params, &*report.now, spring)?;
    let [i, j] = now.points.map(|point| report.now.positions.get(point).map(|place| place.as_dvec3()));
    Some(SpringReading {
        spring,
        now,
        stiffness: f64::from(*params.spring_stiffness.get(spring)?),
        damping: f64::from(*params.spring_damping.get(spring)?),
        axis: (i? - j?).normalize_or_zero(),
    })
}

/// A point and what acts on it; `None` if there is no such point.
pub fn point(report: &Report, point: usize) -> Option<PointReading> {
    let (model, params) = (&report.opened.model, &report.params);
    let now = sprung::PointReading::of(model, params, &*report.now, point)?;
    Some(PointReading { point, now, spring_count: model.springs_at(point).len(), dt: params.dt })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::scene::Scene;
    use sprung_driver::{Command, Driver, Handle, Source};

    /// What is said of the next step is what the engine then does, to the rounding of float32.
    #[test]
    fn the_numbers_foretell_the_step() {
        for name in ["spring", "chain", "jelly", "cloth"] {
            let scene = Scene::builtin(name).expect("it is there");
            let mut driver =
                Handle::inline(Driver::new(Source { name: name.to_owned(), scene }).expect("it builds"));
            // Far enough for the jelly to lie in its plane.
            (0..if name == "jelly" { 15 } else { 4 }).for_each(|_| driver.send(Command::Frame));
            let before = driver.report();
            driver.send(Command::Step);
            let after = driver.report();
            let count = before.now.positions.len();
            for index in [0, 1, count / 2, count - 1] {
                let told = point(&before, index).expect("there is such a point");
                let (place, rate) = (after.now.positions[index], after.now.velocities[index]);
                assert!((told.new_velocity() - rate.as_dvec3()).length() < 2e-4, "{name}, point {index}");
                assert!((told.new_position() - place.as_dvec3()).length() < 2e-5, "{name}, point {index}");
            }
            assert!(point(&before, count).is_none() && spring(&before, usize::MAX).is_none());
        }
    }
}
