//! Anything in any order: no panic, nothing that is not finite, reports that agree with themselves, and a record that
//! replays bit for bit.

mod common;

use common::acts::{act, options};
use common::{at, check, kept, source};
use proptest::prelude::*;
use sprung_driver::{Command, Driver, Handle, Pace, Trouble};

proptest! {
    #![proptest_config(common::cases(300))]

    #[test]
    fn anything_in_any_order(acts in prop::collection::vec(act(), 1..150)) {
        let mut driver = Driver::with(source("chain"), options()).expect("it opens");
        for act in acts {
            act.act(&mut driver, &mut Driver::obey, &|driver| {
                let report = driver.report();
                report.checkpoint.is_some().then(|| kept(&report))
            });
            check(&driver.report());
        }
        // Whatever happened: it replays.
        while !driver.is_idle() {
            driver.obey(Command::Play(false));
            driver.advance(0.0, &mut || true);
        }
        driver.obey(Command::Release);
        driver.advance(0.0, &mut || true);
        let mut handle = Handle::inline(driver);
        let timeline = handle.report().timeline.clone();
        let (first, newest) = (timeline.first.0, timeline.newest.0);
        let half_way = first.midpoint(newest);
        let end = at(&mut handle, newest);
        let middle = at(&mut handle, half_way);
        at(&mut handle, first);
        prop_assert_eq!(at(&mut handle, half_way), middle);
        at(&mut handle, first);
        handle.send(Command::Pace(Pace::RealTime));
        handle.send(Command::Play(true));
        let mut turns = 0;
        while handle.report().now.step < newest {
            handle.send(Command::Step);
            turns += 1;
            prop_assert!(turns < 1_000_000);
        }
        prop_assert_eq!(&handle.report().now, &end);
        prop_assert!(!matches!(handle.report().trouble, Some(Trouble::BlewUp(_))));
    }
}
