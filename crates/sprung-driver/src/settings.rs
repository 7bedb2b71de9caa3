//! Parameters as the user set them: without the hands that pull just now.

use std::sync::Arc;

use sprung::Params;

use crate::substeps::Auto;

/// What an edit changes: the parameters, and whether sub-steps are chosen.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Setting {
    pub params: Arc<Params>,
    pub auto: Option<Auto>,
}

impl Setting {
    /// Whether the two ask for the same.
    pub fn is_same(&self, other: &Self) -> bool {
        self.auto == other.auto && settings_are_same(&self.params, &other.params)
    }
}

/// The parameters without the hand's grabs and the points that it carries.
pub(crate) fn without_hands(params: &Params) -> Params {
    Params { grabs: Vec::new(), carried: Default::default(), ..params.clone() }
}

/// The parameters with the hands of others.
pub(crate) fn with_hands_of(params: &Params, others: &Params) -> Params {
    Params { grabs: others.grabs.clone(), carried: others.carried.clone(), ..params.clone() }
}

/// Whether all parameters are the same, with the very same long arrays: cheap, whatever the size of the model.
pub(crate) fn are_identical(a: &Params, b: &Params) -> bool {
    small_are_same(a, b)
        && a.grabs == b.grabs
        && a.carried == b.carried
        && Arc::ptr_eq(&a.point_mass, &b.point_mass)
        && Arc::ptr_eq(&a.point_pinned, &b.point_pinned)
        && Arc::ptr_eq(&a.spring_stiffness, &b.spring_stiffness)
        && Arc::ptr_eq(&a.spring_damping, &b.spring_damping)
        && Arc::ptr_eq(&a.spring_rest_length, &b.spring_rest_length)
        && Arc::ptr_eq(&a.spring_cut, &b.spring_cut)
}

/// Whether all parameters are the same, whatever the hands do. Long arrays are compared by where they lie first: that is
/// nearly always enough.
pub(crate) fn settings_are_same(a: &Params, b: &Params) -> bool {
    small_are_same(a, b) && arrays_are_same(a, b)
}

/// Whether all that the limits on dt depend on is the same, but for the positions.
pub(crate) fn limits_are_same(a: &Params, b: &Params) -> bool {
    a.planes == b.planes
        && a.carried.keys().eq(b.carried.keys())
        && a.grabs.len() == b.grabs.len()
        && a.grabs
            .iter()
            .zip(&b.grabs)
            .all(|(a, b)| (a.point, a.stiffness, a.damping) == (b.point, b.stiffness, b.damping))
        && arrays_are_same(a, b)
}

fn small_are_same(a: &Params, b: &Params) -> bool {
    (a.dt, a.substeps, a.gravity) == (b.dt, b.substeps, b.gravity)
        && a.planes == b.planes
        && a.external_forces == b.external_forces
}

fn arrays_are_same(a: &Params, b: &Params) -> bool {
    fn same<T: PartialEq>(a: &Arc<Vec<T>>, b: &Arc<Vec<T>>) -> bool {
        Arc::ptr_eq(a, b) || a == b
    }
    same(&a.point_mass, &b.point_mass)
        && same(&a.point_pinned, &b.point_pinned)
        && same(&a.spring_stiffness, &b.spring_stiffness)
        && same(&a.spring_damping, &b.spring_damping)
        && same(&a.spring_rest_length, &b.spring_rest_length)
        && same(&a.spring_cut, &b.spring_cut)
}
