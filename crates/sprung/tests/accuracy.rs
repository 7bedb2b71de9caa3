//! What float32 costs: the engine beside the float64 twin, and beside a plain float32 loop that keeps nothing of what
//! rounding drops. `cargo run --release -p sprung --example accuracy` prints the numbers, of more and longer runs.

mod common;

use common::hanging::{Hanging, Shape};
use common::motion::{Motion, Ours, twin_of};
use common::plain::Plain;
use common::{moving, scenes};

/// No margin. Each hundred steps are judged by themselves: small errors at the beginning must not hide behind the large ones
/// that any difference grows into.
#[test]
fn the_error_in_motion_is_no_larger_than_a_plain_loops() {
    for scene in scenes::four() {
        for (hundreds, [ours, plain]) in moving::errors(&scene, 4, 4).into_iter().enumerate() {
            let from = 100 * hundreds;
            assert!(
                ours <= plain,
                "{}, from step {from}: off by {ours:e} m, plain by {plain:e} m",
                scene.name
            );
        }
    }
}

/// How far the knocked cloth is from the float64 equilibrium after some seconds of steps of DT/parts.
fn error<M: Motion>(cloth: &Hanging, motion: fn(&Hanging) -> M, parts: u64, seconds: f64) -> Shape {
    cloth.error(cloth.rest(&mut motion(cloth), parts, seconds))
}

fn ours(cloth: &Hanging) -> Ours {
    Ours::new(&cloth.model, &cloth.params, &cloth.knocked)
}

fn plain(cloth: &Hanging) -> Plain {
    Plain::new(&cloth.model, &cloth.params, &cloth.knocked)
}

/// At the report's step the engine comes as close to the equilibrium as the twin does in the same time, and with 10 and
/// 100 times as many steps as close as with the report's: but for what rounding each position once, and computing each
/// force in float32, does to strain and force ([`common::rounding`]).
fn substeps_never_make_it_worse(cloth: &Hanging, seconds: f64) {
    let exact = error(cloth, |cloth| twin_of(&cloth.model, &cloth.params, &cloth.knocked), 1, seconds);
    let at_dt = error(cloth, ours, 1, seconds);
    assert!(
        at_dt.is_within(exact, cloth.rounding),
        "{at_dt:?}, the twin {exact:?}, but for {:?}",
        cloth.rounding
    );
    for parts in [10, 100] {
        let finer = error(cloth, ours, parts, seconds);
        assert!(
            finer.is_within(at_dt, cloth.rounding),
            "dt/{parts}: {finer:?}, at dt {at_dt:?}, but for {:?}",
            cloth.rounding
        );
    }
}

#[test]
fn substeps_never_make_the_hanging_cloth_worse_as_they_do_in_a_plain_loop() {
    let cloth = Hanging::new(20);
    substeps_never_make_it_worse(&cloth, 6.0);
    // The plain loop leaves seven times the force that rounding explains, and a strain off by twenty times as much.
    let [at_dt, finer] = [1, 100].map(|parts| error(&cloth, plain, parts, 6.0));
    assert!(finer.residual > at_dt.residual + cloth.rounding.residual, "{finer:?}, at dt {at_dt:?}");
    assert!(finer.strain > at_dt.strain + cloth.rounding.strain, "{finer:?}, at dt {at_dt:?}");
}

#[test]
fn substeps_never_make_a_cloth_of_64_by_64_worse() {
    substeps_never_make_it_worse(&Hanging::new(64), 4.0);
}
