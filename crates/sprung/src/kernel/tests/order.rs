//! The fast step is the plain one, bit for bit: the order of summation is what the documentation says.

use super::networks::{Random, mixed, with_hidden_order};
use super::twin::{self, Order};
use super::{Parts, affordable, first_difference};
use crate::build::{Material, ModelBuilder};
use crate::kernel::BLOCK;
use crate::kernel::laws::{Law, Laws};
use crate::kernel::level::Level;
use crate::kernel::plan::{MOST_ROWS, Plan, WINDOW};
use crate::model::HiddenOrder;
use crate::scene::BUILTIN;

/// Compares so many steps.
pub fn assert_is_the_twin(name: &str, parts: &Parts, steps: u64) {
    let (order, mut state) = (Order::new(&parts.model), parts.state.clone());
    let mut team = parts.team(Level::best());
    for step in 1..=steps {
        parts.advance(&mut team, 1, 1);
        twin::step::<f32>(parts, &order, &mut state);
        let difference = first_difference(&parts.state_of(&team), &state);
        assert_eq!(difference, None, "{name}, step {step}: the kernel and its plain twin differ");
    }
}

#[test]
fn built_in_scenes_move_as_their_plain_twins() {
    for scene in BUILTIN {
        assert_is_the_twin(scene.name, &Parts::built_in(scene), affordable(scene, 1, 30));
    }
}

/// The networks go through every loop there is, with every kind of law.
#[test]
fn mixed_networks_have_something_of_everything() {
    let parts = mixed(0, 12_000, false);
    let plan = Plan::new(&parts.model);
    let laws = Laws::new(&plan, &parts.model, &parts.params);
    let kinds = |laws: &[Law]| {
        let has = |kind: fn(&Law) -> bool| laws.iter().any(kind);
        [
            has(|law| matches!(law, Law::Same(_))),
            has(|law| matches!(law, Law::Lengths(..))),
            has(|law| matches!(law, Law::Each(_))),
        ]
    };
    assert_eq!(kinds(&laws.stripes), [false, true, true], "stripes");
    assert_eq!(kinds(&laws.bundles), [false, true, true], "bundles");
    assert!(plan.bundles.iter().any(|bundle| bundle.rows.len() == MOST_ROWS), "a star fills its lanes");
    assert!(plan.loose.is_empty() && plan.border_blocks() > 1, "regions share several blocks");
    assert!(!Plan::new(&mixed(20, 70_000, true).model).loose.is_empty(), "some springs are loose");
    // The third kind of law is that of regular scenes.
    let cloth =
        BUILTIN.iter().find(|scene| scene.name == "cloth").map(Parts::built_in).expect("it is built in");
    let laws = Laws::new(&Plan::new(&cloth.model), &cloth.model, &cloth.params);
    assert_eq!(kinds(&laws.stripes), [true, false, false], "stripes of a cloth");
}

#[test]
fn mixed_networks_move_as_their_plain_twins() {
    for seed in 0..6 {
        assert_is_the_twin(&format!("network {seed}"), &mixed(seed, 3_000, false), 20);
    }
}

#[test]
fn networks_in_any_hidden_order_move_as_their_plain_twins() {
    for seed in 10..14 {
        let parts = mixed(seed, 2_000, false);
        let model = with_hidden_order(&parts.model, &mut Random(seed));
        assert_is_the_twin(&format!("network {seed}"), &Parts { model, ..parts }, 20);
    }
}

/// Springs between points so far apart that 16 bits do not say how far.
#[test]
fn springs_beyond_the_window_move_as_their_plain_twins() {
    let parts = mixed(20, 70_000, true);
    let far =
        |&[a, b]: &[u32; 2]| parts.model.place_of(a as usize).abs_diff(parts.model.place_of(b as usize));
    assert!(parts.model.springs.iter().map(far).max() > Some(1 << 16), "some are that far apart");
    assert_is_the_twin("a wide network", &parts, 3);
}

/// The longest springs that 16 bits can say and the shortest that they cannot, from the beginning and the end of a block.
#[test]
fn springs_at_the_edge_of_the_window_move_as_their_plain_twins() {
    for longest in [WINDOW - 1, WINDOW - BLOCK, WINDOW + 1] {
        let mut builder = ModelBuilder::new();
        let random = &mut Random(longest as u64);
        for _ in 0..WINDOW + 40 * BLOCK {
            let point = builder.add_point(random.vector(), 1.0).expect("allowed");
            builder.set_velocity(point, random.vector()).expect("allowed");
        }
        for (block, length) in (longest - 5..=longest).enumerate() {
            for near in [0, 1, BLOCK - 1] {
                let near = 6 * block * BLOCK + near;
                builder
                    .add_spring(near, near + length, Material { stiffness: 5.0, damping: 0.1 })
                    .expect("allowed");
            }
        }
        let (mut model, params, state) = builder.parts().expect("there are points");
        model.hidden_order = HiddenOrder::default();
        assert_is_the_twin(&format!("springs of {longest} places"), &Parts::new((model, params, state)), 2);
    }
}
