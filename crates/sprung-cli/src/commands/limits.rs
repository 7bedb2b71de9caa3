//! What sets a limit on the step, in words, and what would allow a longer one.

use sprung::scene::Scene;
use sprung::stability::{Limit, Setter};
use sprung::{Params, Simulation, significant as rounded};

/// Which contacts a limit counts.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Contacts {
    /// Those of points that touch a plane now.
    Now,
    /// Those of all points with all planes.
    Ever,
}

/// What sets a limit: `spring 12 of jelly (points 3 and 4)`, `the contact of point 0 of jelly (0.00125 kg) with a plane of
/// stiffness 1000 N/m`.
pub fn describe(simulation: &Simulation, limit: &Limit, contacts: Contacts) -> String {
    let model = simulation.model();
    let point = match limit.setter {
        Setter::Spring(spring) => return model.spring_name(spring),
        Setter::Point(point) => point,
    };
    let name = model.point_name(point);
    match Contact::of(simulation, point, limit.dt, contacts) {
        None => format!("the contact or grab at {name}"),
        Some(Contact { mass, key, value, .. }) => {
            format!("the contact of {name} ({} kg) with a plane of {key} {value}", rounded(mass))
        }
    }
}

/// What to change for a longer step where a contact sets a limit: `a lower plane.stiffness, or heavier points; …`.
pub fn remedy(simulation: &Simulation, scene: &Scene, limit: &Limit, contacts: Contacts) -> Option<String> {
    let Setter::Point(point) = limit.setter else { return None };
    let Contact { mass, key, plane, .. } = Contact::of(simulation, point, limit.dt, contacts)?;
    let (model, params) = (simulation.model(), simulation.params());
    let which = if params.planes.len() == 1 { String::new() } else { format!("{plane}.") };
    let mut sentence = format!("a lower plane.{which}{key}, or a heavier {}", model.point_name(point));
    let body = model.bodies().iter().find(|body| body.points.contains(&point))?;
    let mean = mean_mass(params, body.points.clone());
    if mass < 0.99 * mean {
        sentence += &format!(": points of {} have {} kg in the mean", body.name, rounded(mean));
    }
    let filled = scene.bodies.iter().any(|found| found.name == body.name && found.soft.is_some());
    if filled {
        sentence += &format!("; a larger body.{}.soft.spacing makes all its points heavier", body.name);
    }
    Some(sentence)
}

/// The contact that asks most of a point.
struct Contact {
    /// Of the point, kg.
    mass: f64,
    /// The number of the plane.
    plane: usize,
    /// The key of the plane that matters most, and its value.
    key: &'static str,
    value: String,
}

impl Contact {
    /// None where the point is grabbed, too, or touches nothing.
    fn of(simulation: &Simulation, point: usize, dt: f64, contacts: Contacts) -> Option<Self> {
        let (params, position) = (simulation.params(), simulation.state().position[point]);
        if params.grabs.iter().any(|grab| grab.point == point) {
            return None;
        }
        let counts = |depth: f32| contacts == Contacts::Ever || depth > 0.0;
        let planes = params.planes.iter().enumerate().filter(|(_, plane)| counts(plane.depth(position)));
        // A step of dt asks dt²·k + 2·dt·d of it.
        let demands = planes.map(|(index, plane)| {
            (index, plane, [dt * dt * f64::from(plane.stiffness), 2.0 * dt * f64::from(plane.damping)])
        });
        let (plane, found, [by_stiffness, by_damping]) = demands
            .max_by(|(.., one), (.., other)| one.iter().sum::<f64>().total_cmp(&other.iter().sum::<f64>()))?;
        let (key, value) = if by_stiffness >= by_damping {
            ("stiffness", format!("{} N/m", rounded(found.stiffness.into())))
        } else {
            ("damping", format!("{} N·s/m", rounded(found.damping.into())))
        };
        Some(Self { mass: params.point_mass[point].into(), plane, key, value })
    }
}

/// Of the points that can move, kg.
fn mean_mass(params: &Params, points: std::ops::Range<usize>) -> f64 {
    let free = points.filter(|&point| !params.is_fixed(point));
    let (sum, count) =
        free.fold((0.0, 0.0), |(sum, count), point| (sum + f64::from(params.point_mass[point]), count + 1.0));
    sum / count
}
