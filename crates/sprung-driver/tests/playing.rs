//! The accumulator: real time goes in, whole steps come out.

mod common;

use common::{check, frames, open};
use sprung::Change;
use sprung_driver::{Command, Driver, Pace};

#[test]
fn sixty_frames_make_a_second_whatever_the_pace() {
    let paces =
        [(Pace::RealTime, 100), (Pace::Slow(2.0), 50), (Pace::Slow(100.0), 1), (Pace::Frames, 60 * 7)];
    for (pace, steps) in paces {
        let mut handle = open("chain");
        handle.send(Command::Pace(pace));
        handle.send(Command::Play(true));
        frames(&mut handle, 60);
        let report = handle.report();
        assert_eq!(report.now.step, steps, "{pace}");
        let wanted = 0.01 * steps as f64;
        // Sums of some thirty terms, each rounded.
        let off = 32.0 * f64::EPSILON * wanted;
        assert!((report.speed - wanted).abs() <= off, "{pace}: {} instead of {wanted}", report.speed);
        check(&report);
    }
}

#[test]
fn what_is_drawn_moves_evenly_between_the_last_two_steps() {
    let mut handle = open("spring");
    handle.send(Command::Pace(Pace::Slow(10.0)));
    handle.send(Command::Play(true));
    let mut last: Option<f64> = None;
    for _ in 0..200 {
        handle.pass(1.0 / 60.0);
        let report = handle.report();
        check(&report);
        let time = report.before.time + report.blend * (report.now.time - report.before.time);
        if let Some(last) = last
            && report.now.step > 1
        {
            assert!((time - last - 1.0 / 600.0f64).abs() < 1e-9, "from {last} to {time}");
        }
        last = Some(time);
    }
    handle.send(Command::Play(false));
    let report = handle.report();
    assert_eq!((report.blend, report.playing, report.speed), (1.0, false, 0.0));
}

#[test]
fn a_driver_that_cannot_keep_up_slows_down_and_says_so() {
    let mut driver = Driver::new(common::source("chain")).expect("it opens");
    driver.obey(Command::Play(true));
    // 0.05 s are five steps; there is time for two of them.
    for _ in 0..60 {
        let mut left = 2;
        driver.advance(0.05, &mut || {
            left -= 1;
            left >= 0
        });
        driver.measured(0.04);
    }
    let report = driver.report();
    assert_eq!(report.now.step, 120);
    assert!((report.speed - 0.4).abs() < 1e-9, "{}", report.speed);
    assert!((report.seconds_per_step - 0.02).abs() < 1e-12);
    // What was dropped is not caught up on.
    driver.advance(0.0, &mut || true);
    assert!(driver.report().now.step <= 121);
    check(&driver.report());
}

#[test]
fn steps_and_frames_pause_and_take_exactly_that_many() {
    let mut handle = open("chain");
    handle.send(Command::Play(true));
    handle.pass(0.1);
    handle.send(Command::Step);
    let report = handle.report();
    assert_eq!((report.now.step, report.playing, report.blend), (11, false, 1.0));
    handle.send(Command::Frame);
    assert_eq!(handle.report().now.step, 18);
    handle.pass(1.0);
    assert_eq!(handle.report().now.step, 18);
    handle.send(common::edit("sub-steps", Change::Substeps(3)));
    handle.send(Command::Frame);
    assert_eq!(handle.report().now.step, 21);
}

#[test]
fn a_frame_of_many_steps_comes_in_portions() {
    let mut driver = Driver::new(common::source("chain")).expect("it opens");
    driver.obey(Command::Edit(sprung_driver::Edit::new("sub-steps", vec![Change::Substeps(1000)])));
    driver.obey(Command::Frame);
    driver.obey(Command::Step);
    let mut portions = 0;
    while !driver.is_idle() {
        let mut left = 100;
        driver.advance(0.01, &mut || {
            left -= 1;
            left >= 0
        });
        portions += 1;
        check(&driver.report());
        assert!(portions < 100, "it does not end");
    }
    assert_eq!(driver.report().now.step, 1001);
    assert!(portions >= 10, "{portions} portions");
}

#[test]
fn time_that_is_no_time_is_no_time() {
    let mut handle = open("spring");
    handle.send(Command::Play(true));
    for seconds in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0] {
        handle.pass(seconds);
        check(&handle.report());
    }
    assert_eq!(handle.report().now.step, 0);
    handle.send(Command::Pace(Pace::Slow(0.0)));
    handle.send(Command::Pace(Pace::Slow(f64::NAN)));
    handle.pass(0.1);
    check(&handle.report());
    assert!(handle.report().now.step <= 10);
}

/// After hours of sleep nobody waits for what was missed.
#[test]
fn a_long_sleep_is_not_caught_up_on() {
    let mut handle = open("spring");
    handle.send(Command::Play(true));
    handle.pass(10_000.0);
    assert!(handle.report().now.step <= 25);
}
