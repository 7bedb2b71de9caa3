//! The slips of the report this method comes from, and what each of them does. None of them is in the engine: here they
//! are written out in a few lines of plain float64, beside what the engine does instead.
//!
//! Run it with `cargo run --example report_slips`. Every claim is asserted.
#![allow(clippy::print_stdout)]

use sprung::{ContactLaw, Material, ModelBuilder, Plane, Simulation, Vec3};

/// Two free masses of 1 kg on a line: position (m) and velocity (m/s) of each.
#[derive(Clone, Copy, Debug)]
struct Pair {
    x: [f64; 2],
    v: [f64; 2],
}

/// A spring of 100 N/m with a damper of 4 N·s/m, 1 m long at rest.
const STIFFNESS: f64 = 100.0;
const DAMPING: f64 = 4.0;
const REST: f64 = 1.0;
const DT: f64 = 0.01;

impl Pair {
    /// A stretched spring between masses that move apart; together they have a momentum of 1 kg·m/s.
    fn start() -> Self {
        Self { x: [0.0, 1.5], v: [0.0, 1.0] }
    }

    fn momentum(&self) -> f64 {
        self.v[0] + self.v[1]
    }

    /// One step. The force on i is F^s + F^d. `sign` is that of F^s in the force on j: the report prints F^s − F^d, +1;
    /// Newton's third law wants −F^s − F^d, −1.
    fn step(&mut self, sign: f64) {
        let e = self.x[0] - self.x[1];
        let (length, u) = (e.abs(), e.signum());
        let spring = -STIFFNESS * (length - REST) * u;
        let damper = -DAMPING * (self.v[0] - self.v[1]);
        self.v[0] += DT * (spring + damper);
        self.v[1] += DT * (sign * spring - damper);
        self.x[0] += DT * self.v[0];
        self.x[1] += DT * self.v[1];
    }
}

fn main() -> sprung::Result<()> {
    println!("{:<34} {:>22} {:>22}", "", "as the report has it", "as it should be");
    momentum()?;
    axis_at_rest()?;
    first_touch()?;
    lift_off()
}

fn row(what: &str, slip: &str, right: &str) {
    println!("{what:<34} {slip:>22} {right:>22}");
}

/// The force on j as printed: momentum comes from nowhere.
fn momentum() -> sprung::Result<()> {
    let (mut slip, mut right) = (Pair::start(), Pair::start());
    for _ in 0..100 {
        slip.step(1.0);
        right.step(-1.0);
    }
    let mut builder = ModelBuilder::new();
    builder.add_point(Vec3::ZERO, 1.0)?;
    builder.add_point(Vec3::X * 1.5, 1.0)?;
    builder.set_velocity(1, Vec3::X)?;
    let spring =
        builder.add_spring(0, 1, Material { stiffness: STIFFNESS as f32, damping: DAMPING as f32 })?;
    builder.set_rest_length(spring, REST as f32)?;
    let (model, mut params, state) = builder.build()?;
    params.gravity = Vec3::ZERO;
    let mut engine = Simulation::new(model, params, state)?;
    for _ in 0..100 {
        engine.step(DT)?;
    }
    let of_engine = engine.state().velocity.iter().map(|v| f64::from(v.x)).sum::<f64>();
    row("momentum after 1 s (was 1 kg m/s)", &format!("{:.3}", slip.momentum()), &format!("{of_engine:.3}"));
    assert!((slip.momentum() - 1.0).abs() > 0.1, "the slip makes momentum of nothing");
    assert!((right.momentum() - 1.0).abs() < 1e-12);
    assert!((of_engine - 1.0).abs() < 1e-5);
    Ok(())
}

/// The damper's axis as normalize(F^s): 0/0 wherever a spring is at rest length, which is where every scene starts.
fn axis_at_rest() -> sprung::Result<()> {
    let e = [0.0, REST];
    let length = f64::hypot(e[0], e[1]);
    let force = e.map(|component| -STIFFNESS * (length - REST) * component / length);
    let size = f64::hypot(force[0], force[1]);
    let slip = force.map(|component| component / size);
    let right = e.map(|component| component / length);
    row(
        "damper's axis at rest length",
        &format!("({}, {})", slip[0], slip[1]),
        &format!("({}, {})", right[0], right[1]),
    );
    assert!(slip.iter().all(|component| component.is_nan()));
    assert_eq!(right, [0.0, 1.0]);
    Ok(())
}

/// Depth measured to y = 0 instead of to the plane at y = −10: the first touch is a kick of k_c·10.
fn first_touch() -> sprung::Result<()> {
    let (stiffness, plane_y, y): (f64, f64, f64) = (50.0, -10.0, -10.001);
    let slip = if y < plane_y { stiffness * (0.0 - y) } else { 0.0 };
    let engine = push_on(y as f32, 0.0, ContactLaw::Report)?;
    row("force 1 mm below a plane at -10 m", &format!("{slip:.2} N"), &format!("{engine:.2} N"));
    assert!((slip - 500.05).abs() < 0.01);
    assert!((engine - 0.05).abs() < 0.001, "{engine}");
    Ok(())
}

/// A spring and damper to the ground also pull: a point that leaves fast is held down. The law "push" lets it go.
fn lift_off() -> sprung::Result<()> {
    let (report, push) = (push_on(-10.1, 2.0, ContactLaw::Report)?, push_on(-10.1, 2.0, ContactLaw::Push)?);
    row("force on leaving at 2 m/s", &format!("{report:.2} N"), &format!("{push:.2} N"));
    assert!((report - (50.0 * 0.1 - 10.0 * 2.0)).abs() < 0.01, "{report}");
    assert_eq!(push, 0.0);
    Ok(())
}

/// The engine's contact force on a point of 1 kg at height `y` (m) and speed `v` (m/s): how its speed changes in a step.
fn push_on(y: f32, v: f32, law: ContactLaw) -> sprung::Result<f64> {
    let mut builder = ModelBuilder::new();
    builder.add_point(Vec3::Y * y, 1.0)?;
    builder.set_velocity(0, Vec3::Y * v)?;
    let (model, mut params, state) = builder.build()?;
    params.gravity = Vec3::ZERO;
    params.planes = vec![Plane { law, ..Plane::level(-10.0, 50.0, 10.0) }];
    let mut engine = Simulation::new(model, params, state)?;
    engine.step(DT)?;
    let state = engine.state();
    let speed = f64::from(state.velocity[0].y) + f64::from(state.velocity_low[0].y);
    Ok((speed - f64::from(v)) / f64::from(DT as f32))
}

#[test]
fn the_claims_hold() {
    main().expect("the engine takes these scenes");
}
