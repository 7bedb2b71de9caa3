//! Reading off one spring or one point, in float64: from a state, or from a snapshot where there is nothing else.

use glam::DVec3;

use crate::force::{FORCES, spring};
use crate::math::COINCIDENT_SQUARED;
use crate::model::Model;
use crate::params::Params;
use crate::state::Moment;

/// What can be told of one spring at one moment.
///
/// ```
/// use sprung::{SpringReading, scene::Scene};
///
/// let simulation = Scene::builtin("chain")?.simulation()?;
/// let (model, params) = (simulation.model(), simulation.params());
/// let reading = SpringReading::of(model, params, simulation.state(), 0).expect("there is a spring 0");
/// assert_eq!((reading.length, reading.tension), (2.0, 0.0));
/// # Ok::<(), sprung::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringReading {
    /// Its two points, the smaller index first.
    pub points: [usize; 2],
    /// Length ℓ, m.
    pub length: f64,
    /// Rest length L, m.
    pub rest_length: f64,
    /// (ℓ − L)/L, how much longer it is than at rest; none for a rest length of zero.
    pub strain: Option<f64>,
    /// dℓ/dt, m/s: positive while it grows longer. Zero while the ends coincide.
    pub stretch_rate: f64,
    /// k_s(ℓ − L), N: positive where it draws its ends together. Zero if it is cut, and while the ends coincide.
    pub spring_force: f64,
    /// k_d·dℓ/dt, N, of the same sign.
    pub damper_force: f64,
    /// Both together, N.
    pub tension: f64,
    /// ½k_s(ℓ − L)², J; zero if it is cut.
    pub energy: f64,
    /// Whether it is cut.
    pub is_cut: bool,
}

impl SpringReading {
    /// Reads off a spring. `None` if there is no such spring, or if the parts are not of one model.
    pub fn of<'a>(
        model: &Model,
        params: &Params,
        moment: impl Into<Moment<'a>>,
        spring: usize,
    ) -> Option<Self> {
        let moment = moment.into();
        let points = model.springs.get(spring)?.map(|end| end as usize);
        if !fit(model, params, moment) {
            return None;
        }
        let [i, j] = points;
        let axis = moment.position(i) - moment.position(j);
        let length = axis.length();
        let has_axis = axis.length_squared() >= f64::from(COINCIDENT_SQUARED);
        let apart = moment.velocity(i) - moment.velocity(j);
        let stretch_rate = if has_axis { apart.dot(axis / length) } else { 0.0 };
        let is_cut = params.spring_cut[spring];
        let [spring_force, damper_force] = if has_axis && !is_cut {
            spring::tensions(params, spring, length, stretch_rate)
        } else {
            [0.0; 2]
        };
        let rest_length = f64::from(params.spring_rest_length[spring]);
        Some(Self {
            points,
            length,
            rest_length,
            strain: (rest_length > 0.0).then(|| (length - rest_length) / rest_length),
            stretch_rate,
            spring_force,
            damper_force,
            tension: spring_force + damper_force,
            energy: spring::stored(params, spring, axis),
            is_cut,
        })
    }
}

/// What can be told of one point at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct PointReading {
    /// Mass, kg; a pinned or carried point has one, too.
    pub mass: f64,
    /// Whether no force can move it: [`Params::is_fixed`].
    pub is_fixed: bool,
    /// Position, m.
    pub position: DVec3,
    /// Velocity, m/s.
    pub velocity: DVec3,
    /// The name of each force of [`FORCES`], in that order, and what it does to this point, N. Gravity and contact do
    /// nothing to a point that is fixed.
    pub forces: Vec<(&'static str, DVec3)>,
    /// All of them together, N.
    pub total_force: DVec3,
}

impl PointReading {
    /// Reads off a point, at a cost that grows with the springs at this point alone. `None` if there is no such point, or
    /// if the parts are not of one model.
    pub fn of<'a>(
        model: &Model,
        params: &Params,
        moment: impl Into<Moment<'a>>,
        point: usize,
    ) -> Option<Self> {
        let moment = moment.into();
        if point >= model.point_count() || !fit(model, params, moment) {
            return None;
        }
        let of_force = |force: &crate::force::Force| (force.name, (force.at)(model, params, moment, point));
        let forces: Vec<(&'static str, DVec3)> = FORCES.iter().map(of_force).collect();
        Some(Self {
            mass: f64::from(params.point_mass[point]),
            is_fixed: params.is_fixed(point),
            position: moment.position(point),
            velocity: moment.velocity(point),
            total_force: forces.iter().map(|(_, force)| *force).sum(),
            forces,
        })
    }
}

/// Whether arrays have the model's lengths: a front end may still hold the snapshot of another scene.
fn fit(model: &Model, params: &Params, moment: Moment<'_>) -> bool {
    let (points, springs) = (model.point_count(), model.spring_count());
    moment.has(points)
        && [params.point_mass.len(), params.point_pinned.len()] == [points; 2]
        && [params.spring_stiffness.len(), params.spring_damping.len()] == [springs; 2]
        && [params.spring_rest_length.len(), params.spring_cut.len()] == [springs; 2]
}
