//! The hand: it holds a point and moves in the plane parallel to the picture through it.

use glam::{Vec2, Vec3};
use sprung_driver::Pull;
use sprung_render::turntable::Turntable;

use super::pick::Seen;

/// How far one may move between the press and the pull, in the window's points; also how long, s.
const SLACK: (f32, f64) = (4.0, 0.15);

/// A press on a point that may become a pull, or be a click.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Press {
    /// The point.
    pub point: usize,
    /// Where it was pressed, from the view's corner, in the window's points.
    pub cursor: Vec2,
    /// When, s.
    pub since: f64,
}

impl Press {
    /// Whether it has become a pull: one who presses on a swinging point wants it held even with a still hand.
    pub fn is_pull(&self, cursor: Vec2, now: f64) -> bool {
        (cursor - self.cursor).length() > SLACK.0 || now - self.since > SLACK.1
    }
}

/// A hand that holds a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hand {
    /// The point.
    pub point: usize,
    /// From the cursor to the point when it was taken, so that it does not jump.
    offset: Vec2,
    /// Distance of the hand along the view, m.
    depth: f32,
    /// What was last asked for.
    asked: Option<Pull>,
}

impl Hand {
    /// Takes a point where it is seen; `None` if it is not.
    pub fn take(point: usize, seen: &Seen, cursor: Vec2) -> Option<Self> {
        let pixel = seen.pixel(point)?;
        // Beyond a few pixels the hand is on a surface, not at the point: there, too, it must not jump.
        Some(Self { point, offset: pixel - cursor, depth: seen.depths[point], asked: None })
    }

    /// Where the hand is, m.
    pub fn target(&self, cursor: Vec2, camera: &Turntable, size: Vec2) -> Vec3 {
        camera.place(cursor + self.offset, self.depth, size)
    }

    /// Moves the hand nearer to the eye (factor above 1) or farther away.
    pub fn come_nearer(&mut self, factor: f32) {
        self.depth = (self.depth / factor.clamp(0.1, 10.0)).clamp(1e-6, 1e8);
    }

    /// What to ask the driver for now, if that has changed.
    pub fn pull(&mut self, cursor: Vec2, camera: &Turntable, size: Vec2, hard: bool) -> Option<Pull> {
        let target = self.target(cursor, camera, size);
        let pull = Pull { point: self.point, target, hard };
        let has_changed = target.is_finite() && self.asked != Some(pull);
        has_changed.then(|| {
            self.asked = Some(pull);
            pull
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Vec2 = Vec2::new(640.0, 480.0);

    fn held() -> (Hand, Turntable, Vec3) {
        let camera = Turntable { target: Vec3::ONE, distance: 8.0, azimuth: 0.5, elevation: 0.3 };
        let place = Vec3::new(1.3, 0.8, 0.4);
        let seen = Seen::new(&camera.camera(SIZE), [place].into_iter());
        let hand = Hand::take(0, &seen, seen.pixels[0] + Vec2::new(5.0, -3.0)).expect("it is seen");
        (hand, camera, place)
    }

    #[test]
    fn a_point_that_is_taken_stays_where_it_is() {
        let (mut hand, camera, place) = held();
        let cursor = camera.camera(SIZE).project(place).expect("it is seen").pixel + Vec2::new(5.0, -3.0);
        let pull = hand.pull(cursor, &camera, SIZE, false).expect("the first is always asked for");
        assert!((pull.target - place).length() < 1e-4);
        assert_eq!(hand.pull(cursor, &camera, SIZE, false), None);
        assert!(hand.pull(cursor, &camera, SIZE, true).is_some_and(|pull| pull.hard));
    }

    #[test]
    fn it_moves_in_the_plane_of_the_picture_until_it_is_brought_nearer() {
        let (mut hand, camera, place) = held();
        let forward = camera.axes()[2];
        let there = hand.target(Vec2::new(17.0, 301.0), &camera, SIZE);
        assert!((there - place).dot(forward).abs() < 1e-4);
        hand.come_nearer(1.25);
        let nearer = hand.target(Vec2::new(17.0, 301.0), &camera, SIZE);
        assert!((nearer - there).dot(forward) < -0.5);
    }

    #[test]
    fn a_still_press_becomes_a_pull_in_time() {
        let press = Press { point: 0, cursor: Vec2::ZERO, since: 1.0 };
        assert!(!press.is_pull(Vec2::new(2.0, 1.0), 1.1));
        assert!(press.is_pull(Vec2::new(9.0, 1.0), 1.01));
        assert!(press.is_pull(Vec2::ZERO, 1.3));
    }
}
