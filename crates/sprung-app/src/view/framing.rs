//! The box of the world that a scene will need: the camera is set before anything has moved.

use sprung::Vec3;
use sprung_driver::Opened;
use sprung_render::camera::Bounds;

/// How long a scene is tried out, s of its time.
const TRIED: f64 = 6.0;
/// How much work that may be: steps times points and springs. A few tens of milliseconds.
const WORK: usize = 4_000_000;

/// The box around some positions; those that are not finite are left out.
pub fn bounds(positions: &[Vec3]) -> Bounds {
    let mut bounds = Bounds::default();
    positions.iter().for_each(|&position| bounds.include(position));
    bounds
}

/// The box around where a scene's points will be in its first seconds.
///
/// A small scene is tried out. In a large one every body that hangs from fixed points is taken to swing down as far as it
/// reaches; what falls lands on a plane, which the camera takes in anyway.
pub fn bounds_of_motion(opened: &Opened) -> Bounds {
    let mut bounds = bounds(&opened.first.positions);
    let size = opened.model.point_count() + opened.model.spring_count();
    let steps = ((TRIED / opened.params.dt) as usize).min(WORK / size.max(1));
    if steps as f64 * opened.params.dt < 0.5 {
        hang(opened, &mut bounds);
        return bounds;
    }
    let Ok(mut trial) = opened.scene.simulation() else { return bounds };
    let whole = 8.0 * bounds.grown(0.0).size().length().max(1e-3);
    for step in 0..steps {
        // What blows up is shown until then, and what falls for ever for a while.
        if trial.step(opened.params.dt).is_err() {
            break;
        }
        if step % 4 == 0 {
            let mut grown = bounds;
            trial.snapshot().positions.iter().for_each(|&position| grown.include(position));
            if grown.size().length() > whole {
                break;
            }
            bounds = grown;
        }
    }
    bounds
}

fn hang(opened: &Opened, bounds: &mut Bounds) {
    let down = opened.params.gravity.normalize_or_zero();
    let positions = &opened.first.positions;
    for body in opened.model.bodies() {
        let fixed = body.points.clone().filter(|&point| opened.params.is_fixed(point));
        let fixed: Vec<Vec3> = fixed.take(64).map(|point| positions[point]).collect();
        let nearest = |place: Vec3| fixed.iter().map(|at| (*at - place).length()).fold(f32::MAX, f32::min);
        // The outline of a body is in any even selection of its points.
        let stride = body.points.len().div_ceil(4096).max(1);
        let reach = body.points.clone().step_by(stride).map(|point| nearest(positions[point]));
        let reach = reach.fold(0.0, f32::max);
        if !fixed.is_empty() && reach.is_finite() {
            fixed.iter().for_each(|&at| bounds.include(at + down * reach));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::scene::Scene;
    use sprung_driver::{Driver, Source};

    fn opened(name: &str) -> std::sync::Arc<Opened> {
        let scene = Scene::builtin(name).expect("it is built in");
        let mut driver = Driver::new(Source { name: name.to_owned(), scene }).expect("it can be built");
        driver.report().opened.clone()
    }

    #[test]
    fn a_pendulum_is_given_room_to_swing() {
        let bounds = bounds_of_motion(&opened("chain"));
        assert!(bounds.low.y < 0.0 && bounds.low.x < -10.0, "{bounds:?}");
    }

    #[test]
    fn what_is_too_large_to_try_is_taken_to_hang_down() {
        let opened = opened("cloth512");
        let (first, motion) = (bounds(&opened.first.positions), bounds_of_motion(&opened));
        assert!(motion.low.y < first.low.y - 0.5 * first.size().max_element(), "{first:?}, {motion:?}");
    }
}
