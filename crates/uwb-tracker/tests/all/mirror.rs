//! A tag of which too few anchors are heard to tell on which of their sides it is.

use crate::common::{CORNERS, anchors, distance, in_every_scalar, sample};
use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::Room;
use kestirim_uwb_tracker::{CalibratedPlaneTracker, CalibratedSpaceTracker, Config};

/// The corners 0 and 2 of the room form a diagonal; the tag is beside its middle at this distance, m.
fn beside_the_diagonal(distance: f64) -> [f64; 3] {
    [4.0 - 0.6 * distance, 3.0 + 0.8 * distance, 1.0]
}

/// A tag in a plane that has moved for some tenths of a second towards the diagonal and back, at 0.4 m/s.
struct Walk<T: Scalar> {
    tracker: CalibratedPlaneTracker<T, 4>,
    time_us: u64,
}

impl<T: Scalar> Walk<T> {
    fn new(config: Config<T>) -> Self {
        let tracker = CalibratedPlaneTracker::new(config, &anchors(&CORNERS, 0.0)).unwrap();
        Self { tracker, time_us: 0 }
    }

    /// Moves from one distance from the diagonal to another, while these anchors are heard.
    fn go(&mut self, from: f64, to: f64, heard: &[usize]) {
        let steps = ((to - from).abs() / 0.04).round() as usize;
        for step in 1..=steps {
            self.time_us += 100_000;
            let tag = beside_the_diagonal(from + (to - from) * step as f64 / steps as f64);
            for &anchor in heard {
                let range = distance(CORNERS[anchor], tag);
                self.tracker.range(&sample(self.time_us, anchor, range)).unwrap();
            }
        }
    }

    /// Distance of the position from the tag, m, and the reported standard deviation.
    fn error_and_sigma(&self, at: f64) -> (f64, f64) {
        let tag = beside_the_diagonal(at);
        let position = self.tracker.position().unwrap().map(T::to_f64);
        let error = (position[0] - tag[0]).hypot(position[1] - tag[1]);
        let health = self.tracker.health(self.time_us);
        (error, health.position_sigma.unwrap().to_f64())
    }

    /// Distance of the mirror image from its expected position, m; `None` without one.
    fn image_beside(&self, at: f64) -> Option<f64> {
        let place = self.tracker.mirror_image()?.map(T::to_f64);
        let tag = beside_the_diagonal(at);
        Some((place[0] - tag[0]).hypot(place[1] - tag[1]))
    }
}

fn check_turn<T: Scalar>() {
    let mut walk = Walk::<T>::new(Config::calibrated(T::ONE));
    walk.go(2.4, 2.0, &[0, 1, 2, 3]);
    walk.go(2.0, 1.6, &[0, 2]);
    assert_eq!(walk.tracker.mirror_image(), None, "not near yet");
    walk.go(1.6, 0.0, &[0, 2]);
    assert!(walk.tracker.mirror_image().is_some());
    // It turns back, and appears to have gone on.
    walk.go(0.0, 2.0, &[0, 2]);
    let (error, sigma) = walk.error_and_sigma(2.0);
    assert!(error < 3.0 * sigma, "{error} m with a σ of {sigma} m");
    let health = walk.tracker.health(walk.time_us);
    assert_eq!(health.in_short().state(), kestirim_health::State::Degraded, "{health:?}");
    let apart = health.mirror.unwrap().to_f64();
    assert!((apart - 4.0).abs() < 0.4, "{apart} m");
    let places = [error, walk.image_beside(2.0).unwrap()];
    assert!(places.iter().any(|error| *error < 0.2), "one of both is right: {places:?}");
    // A third anchor decides at once, or discards the position if it was the wrong one.
    walk.go(2.0, 2.4, &[0, 1, 2, 3]);
    walk.go(2.4, 2.0, &[0, 1, 2, 3]);
    let (error, sigma) = walk.error_and_sigma(2.0);
    assert!(error < 0.2 && sigma < 0.3, "{error} m, σ {sigma} m");
    assert_eq!(walk.tracker.health(walk.time_us).mirror, None);
}

#[test]
fn a_turn_at_the_line_of_two_anchors_leaves_two_places() {
    in_every_scalar!(check_turn);
}

#[test]
fn where_all_are_heard_again_both_places_are_one_on_the_line() {
    let mut walk = Walk::<f64>::new(Config::calibrated(1.0));
    walk.go(2.4, 2.0, &[0, 1, 2, 3]);
    walk.go(2.0, 0.0, &[0, 2]);
    assert!(walk.tracker.mirror_image().is_some());
    walk.go(0.0, 0.08, &[0, 1, 2, 3]);
    walk.go(0.08, 0.0, &[0, 1, 2, 3]);
    assert_eq!(walk.tracker.mirror_image(), None);
    assert!(walk.error_and_sigma(0.0).0 < 0.2);
}

#[test]
fn anchors_on_one_mast_make_no_line() {
    let mut places = CORNERS;
    places[2] = [0.005, 0.0, 0.3];
    let mut tracker =
        CalibratedPlaneTracker::<f64, 4>::new(Config::calibrated(1.0), &anchors(&places, 0.0))
            .unwrap();
    for step in 0..100_u32 {
        let tag = [4.0 - 0.03 * f64::from(step), 3.0 - 0.02 * f64::from(step), 1.0];
        let heard: &[usize] = if step < 20 { &[0, 1, 2, 3] } else { &[0, 2] };
        for &anchor in heard {
            let range = distance(places[anchor], tag);
            tracker.range(&sample(u64::from(step) * 100_000, anchor, range)).unwrap();
        }
    }
    assert_eq!(tracker.mirror_image(), None);
}

#[test]
fn far_from_the_line_two_anchors_leave_one_place() {
    let mut walk = Walk::<f64>::new(Config::calibrated(1.0));
    walk.go(2.4, 2.0, &[0, 1, 2, 3]);
    walk.go(2.0, 2.6, &[0, 2]);
    walk.go(2.6, 2.0, &[0, 2]);
    assert_eq!(walk.tracker.mirror_image(), None);
    let (error, _) = walk.error_and_sigma(2.0);
    assert!(error < 0.1, "{error} m");
}

#[test]
fn a_wall_tells_which_place_it_is() {
    // The anchors 0 and 1 are on one wall of the room, behind which the tag cannot be.
    for room in [None, Some(Room::plane(0.0, 0.0, 8.0, 6.0))] {
        let config = Config { room, ..Config::calibrated(1.0) };
        let mut tracker =
            CalibratedPlaneTracker::<f64, 4>::new(config, &anchors(&CORNERS, 0.0)).unwrap();
        for step in 0..200_u32 {
            let tag = [4.0, 0.5 + (f64::from(step) * 0.02 - 2.0).abs(), 1.0];
            let heard = if step < 20 { 4 } else { 2 };
            for (anchor, &corner) in CORNERS.iter().enumerate().take(heard) {
                let range = distance(corner, tag);
                tracker.range(&sample(u64::from(step) * 100_000, anchor, range)).unwrap();
            }
        }
        assert_eq!(tracker.mirror_image().is_none(), room.is_some());
    }
}

#[test]
fn three_anchors_in_space_leave_two_places_at_their_plane() {
    let places = [[0.0, 0.0, 2.0], [8.0, 0.0, 2.0], [8.0, 6.0, 2.0], [0.0, 6.0, 0.0]];
    let config = Config::calibrated(0.0);
    let mut tracker =
        CalibratedSpaceTracker::<f64, 4>::new(config, &anchors(&places, 0.0)).unwrap();
    for step in 0..100_u32 {
        let tag = [5.0, 2.0, (f64::from(step) * 0.04 - 1.0).min(2.0)];
        let heard = if step < 30 { 4 } else { 3 };
        for (anchor, &place) in places.iter().enumerate().take(heard) {
            let range = distance(place, tag);
            tracker.range(&sample(u64::from(step) * 100_000, anchor, range)).unwrap();
        }
    }
    let (place, other) = (tracker.position().unwrap(), tracker.mirror_image().unwrap());
    assert!((place - other).xy().norm() < 1e-6);
    assert!((place.z + other.z - 4.0).abs() < 1e-6, "{place} and {other}");
}

/// Anchors along one wall: the ranges do not tell on which of its sides the tag is.
fn check_wall<T: Scalar>() {
    let wall = [[0.0, 0.0, 2.0], [4.0, 0.03, 2.4], [8.0, 0.0, 1.6], [6.0, -0.04, 2.0]];
    let bent = [wall[0], wall[1], [8.0, 0.5, 1.6], wall[3]];
    // Twice the error of a range: the filter could begin on either side.
    let hardly = [wall[0], [4.0, 0.2, 2.4], [8.0, 0.2, 1.6], [12.0, 0.0, 2.0]];
    let room = Room::plane(T::ZERO, T::ZERO, T::from_f64(8.0), T::from_f64(6.0));
    for (places, room, is_told, off) in [
        (wall, None, true, 0.4),
        (wall, Some(room), false, 0.4),
        (bent, None, false, 0.4),
        (hardly, None, true, 1.0),
    ] {
        let config = Config { room, ..Config::calibrated(T::ONE) };
        let mut tracker =
            CalibratedPlaneTracker::<T, 4>::new(config, &anchors(&places, 0.0)).unwrap();
        let mut tag = [0.0; 3];
        for step in 0..100_u32 {
            tag = [2.0 + 0.04 * f64::from(step), 4.0, 1.0];
            for (anchor, &place) in places.iter().enumerate() {
                let range = distance(place, tag);
                tracker.range(&sample(u64::from(step) * 100_000, anchor, range)).unwrap();
            }
        }
        let health = tracker.health(9_900_000);
        let apart = health.mirror.map(T::to_f64);
        assert_eq!(apart.is_some(), is_told, "{apart:?}");
        assert!(apart.is_none_or(|apart| (apart - 8.0).abs() < off), "{apart:?}");
        let position = tracker.position().unwrap().map(T::to_f64);
        let error = (position[0] - tag[0]).hypot(position[1] - tag[1]);
        assert!(error < 3.0 * health.position_sigma.unwrap().to_f64(), "{error} m, {health:?}");
    }
}

#[test]
fn anchors_in_one_line_leave_two_places_unless_the_room_is_known() {
    in_every_scalar!(check_wall);
}

#[test]
fn anchors_under_one_ceiling_leave_two_heights_unless_the_room_is_known() {
    let ceiling = [[0.0, 0.0, 3.0], [8.0, 0.0, 3.0], [8.0, 6.0, 3.05], [0.0, 6.0, 3.0]];
    let below = Room { low: [0.0, 0.0, 0.0], high: [8.0, 6.0, 3.0] };
    for room in [None, Some(below)] {
        let config = Config { room, ..Config::calibrated(0.0) };
        let mut tracker =
            CalibratedSpaceTracker::<f64, 4>::new(config, &anchors(&ceiling, 0.0)).unwrap();
        for step in 0..50_u32 {
            let tag = [2.0 + 0.04 * f64::from(step), 4.0, 1.0];
            for (anchor, &place) in ceiling.iter().enumerate() {
                let range = distance(place, tag);
                tracker.range(&sample(u64::from(step) * 100_000, anchor, range)).unwrap();
            }
        }
        assert_eq!(tracker.mirror_image().is_some(), room.is_none());
        let z = tracker.position().unwrap()[2];
        assert!((z - 1.0).abs() < 0.3 || (z - 5.0).abs() < 0.3 && room.is_none(), "{z} m");
    }
}
