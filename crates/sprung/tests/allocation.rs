//! Solvers own their scratch memory: a step takes none.

mod common;

use common::scenes;
use sprung::{Change, Vec3};

#[test]
fn a_step_allocates_nothing() {
    for scene in scenes::four() {
        let mut run = scenes::engine(&scene);
        run.keep_history(0);
        let dt = run.params().dt;
        let last = run.model().point_count() - 1;
        run.change(Change::Carry(last, Some(Vec3::Y))).expect("allowed");
        run.step(dt).expect("it is stable");
        // A hundred steps: the watch looks at five of them and keeps each as the last good state.
        let taken = allocation_counter::measure(|| {
            for _ in 0..100 {
                run.step(dt).expect("it is stable");
            }
        });
        assert_eq!(taken.count_total, 0, "{}", scene.name);
    }
}
