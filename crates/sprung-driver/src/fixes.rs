//! What would mend a run that blew up.

use std::sync::Arc;

use sprung::{BlowUp, Model, Params, Result, Vec3, stability};

use crate::command::Fix;
use crate::substeps::Auto;

/// The fixes under which the last good state is within its certified limit.
pub(crate) fn find(blow_up: &BlowUp, model: &Model, params: &Params, positions: &[Vec3]) -> Vec<Fix> {
    let is_stable = |fix: &Fix| {
        let Ok(params) = mended(*fix, model, params) else { return false };
        stability::certified(model, &params, positions).is_none_or(|limit| params.dt < limit.dt)
    };
    let dt = blow_up.suggested_dt().map(Fix::Dt);
    // Less damping, not more: it, too, asks for short steps.
    let damping = blow_up.suggested_damping_scale().map(Fix::Damping);
    [dt, Some(Fix::Substeps), damping].into_iter().flatten().filter(is_stable).collect()
}

/// The parameters with a fix.
///
/// # Errors
/// If a value is out of range, or no number of sub-steps is stable.
pub(crate) fn mended(fix: Fix, model: &Model, params: &Params) -> Result<Params> {
    let mut params = params.clone();
    match fix {
        Fix::Dt(dt) => params.dt = dt,
        Fix::Substeps => (params.dt, params.substeps) = Auto::new(&params).choose(model, &params)?,
        Fix::Damping(factor) => {
            let damping = params.spring_damping.iter().map(|&damping| (f64::from(damping) * factor) as f32);
            params.spring_damping = Arc::new(damping.collect());
        }
    }
    params.validate(model)?;
    Ok(params)
}
