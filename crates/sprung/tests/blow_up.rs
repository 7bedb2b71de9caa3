//! A run that blows up is caught, its last good state kept, and the cause named; a healthy run is left alone.

mod common;

use common::{oscillator, scenes, simulation, steps};
use sprung::{
    Cause, Change, Code, Error, Grab, Material, ModelBuilder, Plane, SettleOptions, Simulation, Vec3,
    stability,
};

/// Steps until it blows up.
fn blow(run: &mut Simulation, most: u64) -> (Error, f32) {
    let mut fastest = 0.0f32;
    for _ in 0..most {
        if let Err(error) = run.step(run.params().dt) {
            return (error, fastest);
        }
        fastest = run.state().velocity.iter().map(|v| v.length()).fold(fastest, f32::max);
    }
    panic!("{most} steps, and it has not blown up; the fastest point went {fastest} m/s");
}

fn is_finite(run: &Simulation) -> bool {
    let state = run.state();
    state.position.iter().chain(&state.velocity).all(|vector| vector.is_finite())
}

fn jelly(dt: f64) -> Simulation {
    let mut run = scenes::engine(&scenes::jelly());
    run.change(Change::Dt(dt)).expect("allowed");
    run
}

/// The jelly's limit is 0.0119753 s at rest. At 0.013 it goes non-finite near step 400 if nobody looks.
#[test]
fn a_step_over_the_limit_is_caught_and_explained() {
    let mut run = jelly(0.013);
    let (error, _) = blow(&mut run, 1000);
    assert_eq!((error.code(), error.exit_status()), (Code::BlewUp, 3));
    let report = error.blow_up().expect("it says what happened").clone();
    assert!(report.step <= 450, "caught at step {}", report.step);
    assert!((report.time - 0.013 * report.step as f64).abs() < 1e-9);

    // The last good state is the current one, finite and calm, and can be gone on from.
    assert!(is_finite(&run));
    assert_eq!((run.state().step, run.state().time), (report.good_step, report.good_time));
    assert!(report.good_step < report.step);
    assert!(!run.is_suspect());

    // The limit that was crossed, a spring of the jelly with its two points, and a step that mends it.
    let certified = report.dt_limit_certified.expect("springs set a limit");
    let every = report.dt_limit_every_configuration.expect("springs set a limit");
    assert!(every < 0.013 && every <= certified * 1.000_001);
    let spring = report.spring.expect("a spring sets the limit");
    let ends = run.model().springs()[spring].map(|end| end as usize);
    assert_eq!(report.points, ends);
    let fix = report.suggested_dt().expect("a step that mends it");
    assert!(fix < 0.0119753 && fix > 0.003, "{fix}");
    let text = error.to_string();
    for part in [
        format!("t = {} s", sprung::significant(report.time)),
        format!("spring {spring}"),
        format!("points {} and {}", ends[0], ends[1]),
        "limit".to_owned(),
        format!("dt = {fix}"),
    ] {
        assert!(text.contains(&part), "\"{part}\" is missing in: {text}");
    }

    // Or less damping: of the demand of 4, the springs alone make 0.013²·8644 = 1.5.
    let scale = report.suggested_damping_scale().expect("the dampers make the larger part");
    let mut damped = run.clone();
    damped.change(Change::Damping(0..7560, 10.0 * scale as f32)).expect("allowed");
    let limit = stability::certified(damped.model(), damped.params(), &damped.state().position);
    let limit = limit.expect("springs set it").dt;
    assert!(0.013 <= 0.9501 * limit && 0.013 > 0.9 * limit, "0.013 s of {limit} s");
    steps(&mut damped, 200);

    run.change(Change::Dt(fix)).expect("allowed");
    steps(&mut run, 200);
}

/// dt·c = 3 by the dampers alone, over the 2 that are stable, while dt·ω = 1 would be.
#[test]
fn too_much_damping_is_told_by_how_much() {
    let material = Material { stiffness: 100.0, damping: 30.0 };
    let mut run = simulation(oscillator(1.0, material, 1.0, 1.1, 0.0));
    let (error, _) = blow_of_dt(&mut run, 0.1);
    let report = error.blow_up().expect("it says what happened");
    let scale = report.suggested_damping_scale().expect("less damping mends it");
    // (dt/0.95)²ω² + 2(dt/0.95)·s·c = 4, and two digits of s.
    let exact = (4.0 - (0.1f64 / 0.95).powi(2) * 100.0) / (2.0 * 0.1 / 0.95 * 30.0);
    assert!(scale <= exact && scale > 0.95 * exact, "{scale}, exactly {exact}");
    run.change(Change::Damping(0..1, 30.0 * scale as f32)).expect("allowed");
    let limit = stability::certified(run.model(), run.params(), &run.state().position);
    let limit = limit.expect("a spring sets it").dt;
    assert!((0.1 / limit - 0.95).abs() < 0.02, "dt is {} of the limit", 0.1 / limit);
    steps(&mut run, 200);
}

#[test]
fn fixes_keep_to_what_is_allowed() {
    let mut run = simulation(oscillator(1.0, Material { stiffness: 1e12, damping: 0.0 }, 1.0, 1.1, 0.0));
    let (error, _) = blow_of_dt(&mut run, 1.0);
    let report = error.blow_up().expect("it says what happened");
    assert!(report.suggested_dt().is_some());
    assert_eq!(report.suggested_damping_scale(), None, "there is none");
}

/// Two bodies and a joint: what is to blame is named by its number within its body, as the scene file counts.
#[test]
fn springs_and_points_are_named_within_their_body() {
    let mut builder = ModelBuilder::new();
    let soft = Material { stiffness: 1.0, damping: 0.0 };
    for (body, height) in [("upper", 5.0), ("lower", 0.0)] {
        builder.begin_body(body).expect("a new name");
        for x in 0..3 {
            builder.add_point(Vec3::new(x as f32, height, 0.0), 1.0).expect("allowed");
        }
        let first = builder.point_count() - 3;
        builder.add_spring(first, first + 1, soft).expect("allowed");
        builder.add_spring(first + 1, first + 2, Material { stiffness: 1e6, damping: 0.0 }).expect("allowed");
    }
    builder.begin_joint("upper - lower");
    builder.add_spring(2, 3, soft).expect("allowed");
    let (model, mut params, state) = builder.build().expect("there are points");
    assert_eq!(model.point_name(0), "point 0 of upper");
    assert_eq!(model.point_name(5), "point 2 of lower");
    assert_eq!(model.spring_name(1), "spring 1 of upper (points 1 and 2)");
    assert_eq!(model.spring_name(3), "spring 1 of lower (points 1 and 2)");
    assert_eq!(model.spring_name(4), "spring 0 of upper - lower (point 2 of upper and point 0 of lower)");
    assert_eq!((model.point_name(9), model.spring_name(9)), ("point 9".to_owned(), "spring 9".to_owned()));

    params.apply(&model, &Change::Stiffness(1..2, 1.0)).expect("allowed");
    params.apply(&model, &Change::RestScale(0..5, 0.9)).expect("allowed");
    params.dt = 0.01;
    let mut run = simulation((model, params, state));
    let (error, _) = blow(&mut run, 1000);
    let report = error.blow_up().expect("it says what happened");
    assert_eq!((report.spring, &report.points[..]), (Some(3), &[4, 5][..]), "as data, over the whole scene");
    assert_eq!(report.place, "spring 1 of lower (points 1 and 2)");
    assert!(error.to_string().contains("set by spring 1 of lower (points 1 and 2): "), "{error}");
}

/// At 0.0121 the jelly reaches some 361 m/s and never goes non-finite: only its energy tells.
#[test]
fn a_step_barely_over_the_limit_is_caught_by_its_energy() {
    let mut run = jelly(0.0121);
    let (error, fastest) = blow(&mut run, 2000);
    let report = error.blow_up().expect("it says what happened");
    assert!(
        matches!(report.cause, Cause::EnergyFromNowhere { excess } if excess > 0.0),
        "{:?}",
        report.cause
    );
    assert!(is_finite(&run) && fastest.is_finite());
    assert_eq!(run.state().step, report.good_step);
}

#[test]
fn the_very_step_that_is_not_finite_is_caught() {
    let mut run = simulation(oscillator(1.0, Material { stiffness: 1e6, damping: 0.0 }, 1.0, 1.1, 0.0));
    let (error, _) = blow_of_dt(&mut run, 1e3);
    assert_eq!(error.blow_up().map(|report| report.cause), Some(Cause::NotFinite));
    assert!(is_finite(&run));
}

fn blow_of_dt(run: &mut Simulation, dt: f64) -> (Error, f32) {
    run.change(Change::Dt(dt)).expect("allowed");
    blow(run, 100)
}

#[test]
fn after_a_blow_up_state_params_and_log_fit_together() {
    let mut run = scenes::engine(&scenes::chain());
    steps(&mut run, 20);
    run.change(Change::Gravity(Vec3::new(0.0, -5.0, 0.0))).expect("allowed");
    steps(&mut run, 15);
    run.change(Change::Gravity(Vec3::new(1.0, -5.0, 0.0))).expect("allowed");
    run.change(Change::Stiffness(0..14, 1e9)).expect("allowed");
    let (error, _) = blow(&mut run, 500);
    let report = error.blow_up().expect("it says what happened");
    let good = report.good_step;
    assert_eq!(run.state().step, good);
    assert!(run.log().iter().all(|(at, _)| *at <= good), "what came after the good state is forgotten");
    assert_eq!(run.params().gravity, Vec3::new(0.0, -5.0, 0.0), "as the log has it at step {good}");
    assert_eq!(run.params().spring_stiffness[0], 200.0);
    assert_rewinds(&mut run);
}

/// What is there now is what the log says: going back and forth again, and on, gives the same bits.
fn assert_rewinds(run: &mut Simulation) {
    let (state, params) = (run.state().clone(), run.params().clone());
    run.rewind_to(0).expect("the first step");
    run.rewind_to(state.step).expect("it is recorded");
    assert_eq!((run.state(), run.params()), (&state, &params));
}

/// Changes and settling at one and the same step, then a blow-up: what was done before the good state is not done twice.
#[test]
fn a_blow_up_after_settling_goes_back_to_the_settled_state() {
    let mut run = scenes::engine(&scenes::chain());
    steps(&mut run, 7);
    run.change(Change::Gravity(Vec3::new(4.0, -2.0, 0.0))).expect("allowed");
    run.settle(SettleOptions { residual_force: Some(0.5), ..SettleOptions::default() }).expect("it settles");
    run.change(Change::Gravity(Vec3::new(0.0, -9.81, 0.0))).expect("allowed");
    run.settle(SettleOptions { residual_force: Some(0.1), ..SettleOptions::default() }).expect("it settles");
    run.change(Change::Gravity(Vec3::new(0.0, -7.0, 0.0))).expect("allowed");
    let (state, params) = (run.state().clone(), run.params().clone());
    run.change(Change::Dt(0.5)).expect("allowed");
    let with_dt = run.params().clone();
    let _ = blow(&mut run, 500);
    assert_eq!(run.state().step, 7);
    assert_eq!(run.state_hash(), state.hash(), "the settled state, bit for bit");
    assert_eq!(run.params(), &with_dt);
    assert_ne!(run.params(), &params);
    assert_rewinds(&mut run);
}

#[test]
fn a_history_begun_anew_is_never_gone_back_beyond() {
    let mut run = scenes::engine(&scenes::chain());
    steps(&mut run, 23);
    run.change(Change::Gravity(Vec3::new(0.0, -3.0, 0.0))).expect("allowed");
    steps(&mut run, 2);
    run.keep_history(1 << 20);
    let hash = run.state_hash();
    let (error, _) = blow_of_dt(&mut run, 1.0);
    assert!(error.blow_up().expect("it says what happened").good_step >= 25);
    assert!(run.state().step >= 25);
    run.rewind_to(25).expect("the first step of this history");
    assert_eq!(run.state_hash(), hash);
}

#[test]
fn a_run_taken_up_while_suspect_blows_up_at_the_same_step() {
    let mut whole = scenes::engine(&scenes::jelly());
    whole.change(Change::Dt(0.0121)).expect("allowed");
    while whole.state().ledger.suspect_steps < 10 {
        whole.step(0.0121).expect("not yet blown up");
    }
    let (model, params, state) = (whole.model().clone(), whole.params().clone(), whole.state().clone());
    let mut taken_up = Simulation::resume(model, params, state).expect("they fit");
    let [first, second] = [&mut whole, &mut taken_up].map(|run| {
        let error = (0..1000).find_map(|_| run.step(0.0121).err()).expect("it blows up");
        error.blow_up().expect("it says what happened").clone()
    });
    assert_eq!((first.step, first.time, first.cause), (second.step, second.time, second.cause));
}

fn stays_calm(run: &mut Simulation, count: u64, what: &str) {
    for _ in 0..count {
        run.step(run.params().dt).unwrap_or_else(|error| panic!("false alarm, {what}: {error}"));
    }
}

#[test]
fn the_four_scenes_raise_no_alarm() {
    for scene in scenes::four() {
        stays_calm(&mut scenes::engine(&scene), 3000, scene.name);
    }
}

#[test]
fn a_thrown_point_raises_no_alarm() {
    // Also at the one speed for which its energy is exactly zero at the start.
    for (x, v, dt) in [(0.0, 10.0, 0.01), (-5.0, 98.1f32.sqrt(), 1e-3), (1e5, 0.0, 0.1), (0.0, 0.0, 1e-4)] {
        let mut builder = ModelBuilder::new();
        builder.add_point(Vec3::Y * x, 1.0).expect("allowed");
        builder.set_velocity(0, Vec3::new(0.0, v, 0.0)).expect("allowed");
        let (model, mut params, state) = builder.build().expect("there is a point");
        params.dt = dt;
        stays_calm(&mut simulation((model, params, state)), 5000, "thrown");
    }
}

#[test]
fn a_settled_scene_raises_no_alarm() {
    let mut run = scenes::engine(&scenes::chain());
    run.settle(SettleOptions::default()).expect("it settles");
    stays_calm(&mut run, 2000, "settled");
    let mut run = jelly(0.01);
    run.settle(SettleOptions { residual_force: Some(1.0), ..SettleOptions::default() }).expect("it settles");
    stays_calm(&mut run, 500, "settled jelly");
}

#[test]
fn hard_handling_raises_no_alarm() {
    let mut run = scenes::engine(&scenes::cloth());
    let springs = run.model().spring_count();
    let grab = |target| Change::Grab(Grab { point: 210, target, stiffness: 400.0, damping: 0.0 });
    for change in [
        grab(Vec3::new(0.0, 60.0, 20.0)),
        grab(Vec3::new(40.0, -30.0, 20.0)),
        Change::Release(210),
        Change::Gravity(Vec3::new(0.0, 20.0, 0.0)),
        Change::Gravity(Vec3::new(0.0, -30.0, 5.0)),
        Change::Cut(0..springs / 2, true),
        Change::Mass(0..200, 2.0),
        Change::Mass(0..200, 0.5),
        Change::Pin(100..110, true),
        Change::Pin(100..110, false),
        Change::Cut(0..springs / 2, false),
        Change::RestScale(0..springs, 1.2),
        Change::Stiffness(0..springs, 100.0),
        Change::Planes(vec![Plane::level(-5.0, 100.0, 3.0)]),
        Change::Planes(vec![Plane::level(5.0, 100.0, 3.0)]),
        Change::Planes(Vec::new()),
        Change::Force(399, Vec3::new(300.0, 100.0, 0.0)),
    ] {
        let what = format!("{change:?}");
        run.change(change).expect("allowed");
        stays_calm(&mut run, 100, &what);
    }
}
