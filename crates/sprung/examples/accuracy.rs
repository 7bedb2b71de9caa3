//! What float32 costs, in numbers: the tables of docs/benchmarks.md. The tests of the same are in tests/accuracy.rs.
//!
//! `cargo run --release -p sprung --example accuracy` takes half a minute.
#![allow(clippy::print_stdout)]

#[path = "../tests/common/mod.rs"]
mod common;

use common::hanging::{Hanging, Shape};
use common::motion::{Motion, Ours, twin_of};
use common::plain::Plain;
use common::{moving, scenes};

fn main() {
    println!("| scene | steps | sprung, µm | plain, µm | ratio |\n|---|---|---:|---:|---:|");
    for scene in scenes::four() {
        for (hundreds, [ours, plain]) in moving::errors(&scene, 4, 16).into_iter().enumerate() {
            assert!(ours <= plain);
            let (from, to) = (100 * hundreds + 1, 100 * (hundreds + 1));
            let (name, ratio) = (scene.name, ours / plain);
            println!("| {name} | {from}–{to} | {:.2} | {:.2} | {ratio:.2} |", ours * 1e6, plain * 1e6);
        }
    }
    println!(
        "\n| cloth | step | error of strain, ppm: sprung | plain | residual force, mN: sprung | plain |"
    );
    println!("|---|---|---:|---:|---:|---:|");
    for n in [20, 64] {
        hang(n, 6.0);
    }
}

fn hang(n: usize, seconds: f64) {
    let cloth = Hanging::new(n);
    let error = |motion: &mut dyn Motion, parts| cloth.error(cloth.rest(motion, parts, seconds));
    let Hanging { model, params, knocked, equilibrium, rounding, .. } = &cloth;
    let row = |step: &str, ours: Shape, plain: Shape| {
        let [strain, plain_strain] = [ours, plain].map(|shape| shape.strain * 1e6);
        let [force, plain_force] = [ours, plain].map(|shape| shape.residual * 1e3);
        println!("| {n}×{n} | {step} | {strain:.2} | {plain_strain:.2} | {force:.1} | {plain_force:.1} |");
    };
    let exact = error(&mut twin_of(model, params, knocked), 1);
    row("float64, dt", exact, exact);
    for parts in [1, 10, 100] {
        let ours = error(&mut Ours::new(model, params, knocked), parts);
        let plain = error(&mut Plain::new(model, params, knocked), parts);
        row(&format!("dt/{parts}"), ours, plain);
    }
    row("rounding explains", *rounding, *rounding);
    println!(
        "(strain {:.6} and force {:.1e} N at rest in float64)",
        equilibrium.strain, equilibrium.residual
    );
}
