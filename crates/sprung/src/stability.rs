//! How large may dt be?
use crate::{Model, Params, Vec3};
/// x
pub struct Limit {
    /// x
    pub dt: f64,
    /// x
    pub setter: Setter,
}
/// x
#[derive(Clone, Copy)]
pub enum Setter {
    /// x
    Spring(usize),
    /// x
    Point(usize),
}
/// x
pub fn certified(_: &Model, _: &Params, _: &[Vec3]) -> Option<Limit> {
    None
}
/// x
pub fn every_configuration(_: &Model, _: &Params) -> Option<Limit> {
    None
}
/// The dt that `"auto"` stands for, s.
pub fn auto_dt(_model: &Model, _params: &Params) -> f64 {
    0.001
}
