//! The paper's filter.

use crate::common::{CORNERS, anchors, distance, sample};
use kestirim_uwb_tracker::{Error, PublishedConfig, PublishedOutcome, PublishedTracker};
use nalgebra::Vector2;

type Published = PublishedTracker<f64, 2, 4, 4>;

fn epoch(tracker: &mut Published, time_us: u64, tag: [f64; 3]) -> PublishedOutcome {
    for (anchor, &place) in CORNERS.iter().enumerate() {
        tracker.range(&sample(time_us, anchor, distance(place, tag))).expect("a range");
    }
    tracker.end_epoch(time_us)
}

/// The published filter at a position, with ranges that carry no information.
fn blind() -> Published {
    let places = <[_; 4]>::try_from(anchors(&CORNERS, 0.0)).expect("four corners");
    let config = PublishedConfig { range_variance: 1e9, ..PublishedConfig::plain(1.0) };
    let mut tracker = Published::new(config, &places).expect("a room");
    assert_eq!(epoch(&mut tracker, 0, [3.0, 2.0, 1.0]), PublishedOutcome::Started);
    tracker
}

#[test]
fn the_published_filter_moves_as_it_is_pushed() {
    let mut tracker = blind();
    tracker.push(Some([1.0, -2.0]));
    assert_eq!(epoch(&mut tracker, 500_000, [3.0, 2.0, 1.0]), PublishedOutcome::Taken);
    tracker.push(None);
    assert_eq!(epoch(&mut tracker, 1_500_000, [3.0, 2.0, 1.0]), PublishedOutcome::Taken);
    // Half a second of acceleration, and a second with the resulting velocity.
    let mean = tracker.estimate().expect("a filter").mean;
    let expected = [3.0 + 0.125 + 0.5, 2.0 - 0.25 - 1.0, 0.5, -1.0];
    for (found, expected) in mean.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-3, "{mean}");
    }
}

#[test]
fn the_published_filter_begins_at_rest_and_gains_noise_each_step() {
    let mut tracker = blind();
    let variances =
        |tracker: &Published| tracker.estimate().expect("a filter").covariance.variances();
    let begun = variances(&tracker);
    for (found, expected) in begun.iter().zip([1e-4, 1e-4, 0.0, 0.0]) {
        assert!((found - expected).abs() < 1e-9, "{begun}");
    }
    epoch(&mut tracker, 1_000_000, [3.0, 2.0, 1.0]);
    let after = variances(&tracker);
    for (found, expected) in after.iter().zip([1.3e-4, 1.3e-4, 3e-5, 3e-5]) {
        assert!((found - expected).abs() < 1e-8, "{after}");
    }
}

#[test]
fn the_published_filter_understands_ranges_at_its_height() {
    let places = <[_; 4]>::try_from(anchors(&CORNERS, 0.0)).expect("four corners");
    let mut tracker = Published::new(PublishedConfig::plain(0.2), &places).expect("a room");
    tracker.set_height(1.0).expect("a height");
    for step in 0..50 {
        epoch(&mut tracker, step * 100_000, [3.0, 2.0, 1.0]);
    }
    let position = tracker.position().expect("a position");
    assert!((position - Vector2::new(3.0, 2.0)).norm() < 1e-3, "{position}");
    assert_eq!(tracker.set_height(f64::INFINITY), Err(Error::NotFinite));
}

#[test]
fn the_plain_published_filter_learns_nothing_of_its_ranges() {
    let variance = |config: PublishedConfig<f64, 2>, off: f64| {
        let places = <[_; 4]>::try_from(anchors(&CORNERS, 0.0)).expect("four corners");
        let mut tracker = Published::new(config, &places).expect("a room");
        epoch(&mut tracker, 0, [3.0, 2.0, 1.0]);
        epoch(&mut tracker, 100_000, [3.0 + off, 2.0, 1.0]);
        epoch(&mut tracker, 200_000, [3.0, 2.0, 1.0]);
        tracker.estimate().expect("a filter").covariance
    };
    let [plain, adaptive] = [PublishedConfig::plain(1.0), PublishedConfig::adaptive(1.0)];
    let difference = |config| {
        let [near, far] = [0.0, 0.01].map(|off| variance(config, off).to_matrix());
        (near - far).amax() / near.amax()
    };
    // The row of a range hardly depends on the place of linearisation.
    assert!(difference(plain) < 1e-3, "{}", difference(plain));
    assert!(difference(adaptive) > 2.0 * difference(plain), "{}", difference(adaptive));
}
