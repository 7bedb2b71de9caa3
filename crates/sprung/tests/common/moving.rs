//! How far float32 strays from the float64 twin in the four scenes, from one start after another.

use super::motion::{Motion, Ours, stir, twin_of};
use super::plain::Plain;
use super::scenes::{self, Scene};
use super::twin::{V3, dot, sub};

/// Root mean square distance of points from the twin's, m, over so many hundreds of steps each, and over so many starts:
/// the engine's float32 positions, as everybody reads them, and a plain float32 loop's.
///
/// The first start is the scene's own; in the others every point has a random velocity of up to 0.1 m/s along each axis
/// besides. All three begin with the same float32 numbers.
pub fn errors(scene: &Scene, hundreds: usize, starts: u32) -> Vec<[f64; 2]> {
    let simulation = scenes::engine(scene);
    let (model, params) = (simulation.model(), simulation.params());
    let mut squares = vec![[0.0; 2]; hundreds];
    for start in 0..starts {
        let mut state = simulation.state().clone();
        stir(params, &mut state, start, if start == 0 { 0.0 } else { 0.1 });
        let mut twin = twin_of(model, params, &state);
        let (mut ours, mut plain) = (Ours::new(model, params, &state), Plain::new(model, params, &state));
        for squares in &mut squares {
            for _ in 0..100 {
                let all: [&mut dyn Motion; 3] = [&mut ours, &mut plain, &mut twin];
                all.into_iter().for_each(|motion| motion.steps(scene.dt, 1));
                let exact = twin.places();
                squares[0] += mean_square(&ours.seen(), &exact);
                squares[1] += mean_square(&plain.seen(), &exact);
            }
        }
    }
    let root = |sum: f64| (sum / (100.0 * f64::from(starts))).sqrt();
    squares.into_iter().map(|sums| sums.map(root)).collect()
}

fn mean_square(places: &[V3], exact: &[V3]) -> f64 {
    let square = |(a, b): (&V3, &V3)| dot(sub(*a, *b), sub(*a, *b));
    places.iter().zip(exact).map(square).sum::<f64>() / places.len() as f64
}
