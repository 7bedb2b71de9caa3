//! How large may dt be?

use crate::model::Model;
use crate::params::Params;

/// The dt that `"auto"` stands for, s.
pub fn auto_dt(_model: &Model, _params: &Params) -> f64 {
    0.001
}
