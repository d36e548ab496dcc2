//! Counters of a tracker, and the health derived from them.

use super::*;
use crate::{Anchor, RangeSample};
use kestirim_adaptive_kalman::MeasurementNoise;
use nalgebra::vector;

#[test]
fn words_are_those_of_what_was_found() {
    let found = Health {
        state: State::Tracking,
        nis: 1.0,
        taken: 9,
        rejected: 0,
        restarts: 0,
        heard: 4,
        dilution: Some(1.0),
        mirror: None,
        position_sigma: Some(0.1),
        bias_sigma: 0.05,
        distrusted: false,
        still: false,
    };
    let good = kestirim_health::Health::GOOD;
    let only = |reason| good.with(reason, true);
    for (health, words) in [
        (found, good),
        (Health { state: State::Initialising, dilution: None, ..found }, good),
        (Health { state: State::Coasting, dilution: None, ..found }, only(Reason::Dropout)),
        (Health { distrusted: true, ..found }, only(Reason::Rejected)),
        (Health { state: State::Lost, dilution: None, ..found }, only(Reason::NotObservable)),
        (Health { dilution: None, ..found }, only(Reason::NotObservable)),
        (Health { mirror: Some(2.0), ..found }, only(Reason::NotObservable)),
    ] {
        assert_eq!(health.in_short(), words, "{health:?}");
    }
}

#[test]
fn the_mean_nis_is_that_of_the_last_twenty_ranges() {
    let mut counters = Counters::<f64>::new();
    for _ in 0..20 {
        counters.take(11.0);
    }
    // 1 − 1/e of the way from 1 to 11, and slightly more.
    assert!((0.63..0.65).contains(&((counters.nis - 1.0) / 10.0)), "{counters:?}");
    assert_eq!(counters.taken, 20);
}

#[test]
fn a_position_is_given_up_when_more_than_a_third_of_the_ranges_are_left_out() {
    // One of ten ranges fits, one of three, and one of two.
    for (fits, soon) in [(10, 5), (3, 8), (2, 15)] {
        let mut counters = Counters::<f64>::new();
        let given_up = (1..=100).find(|range| {
            if range % fits == 0 {
                counters.take(1.0);
                return false;
            }
            counters.reject(4, false)
        });
        assert!(given_up.is_some_and(|range| range <= soon), "{fits}: {given_up:?}");
    }
    let mut counters = Counters::<f64>::new();
    // Two of three ranges fit.
    for _ in 0..100 {
        assert!(!counters.reject(4, false));
        counters.take(1.0);
        counters.take(1.0);
    }
    assert_eq!((counters.distrust, counters.rejected, counters.taken), (0, 100, 200));
    // A blocked anchor is known.
    assert!((0..100).all(|_| !counters.reject(4, true)));
    assert_eq!((counters.distrust, counters.rejected), (0, 200));
    let left_out = (1..=100).find(|_| counters.reject(4, false));
    assert_eq!(left_out, Some(5), "in a row");
}

#[test]
fn others_agree_if_they_are_more_than_the_coordinates() {
    let mut counters = Counters::<f64>::new();
    let agree = |counters: &Counters<f64>, blocked, heard| counters.others_agree(blocked, heard, 2);
    // Three others: of four with this one, or of three if it is blocked and thus not among them.
    assert!(agree(&counters, false, 4) && !agree(&counters, false, 3));
    assert!(agree(&counters, true, 3) && !agree(&counters, true, 2));
    assert!(!agree(&counters, false, 0));
    counters.nis = 4.1;
    assert!(!agree(&counters, false, 4));
}

#[test]
fn a_position_that_was_begun_is_believed() {
    let mut counters = Counters::<f64>::new();
    counters.take(9.0);
    counters.reject(4, false);
    counters.begun();
    assert_eq!((counters.starts, counters.distrust, counters.nis), (1, 0, 1.0));
}

/// Anchors in a square around the origin, with these times of their last ranges (µs).
fn links(config: &Config<f64>, heard_us: [Option<u64>; 4]) -> [Link<f64>; 4] {
    let places = [[5.0, 0.0, 1.0], [0.0, 5.0, 1.0], [-5.0, 0.0, 1.0], [0.0, -5.0, 1.0]];
    links_at(places, config, heard_us)
}

fn links_at<const A: usize>(
    places: [[f64; 3]; A],
    config: &Config<f64>,
    heard_us: [Option<u64>; A],
) -> [Link<f64>; A] {
    core::array::from_fn(|index| {
        let anchor = Anchor { position: SVector::from(places[index]), bias: 0.0 };
        let mut link = Link::new(anchor, config);
        if let Some(time_us) = heard_us[index] {
            let sample = RangeSample { time_us, anchor: index, range: 5.0 };
            link.hear(time_us, link.admit(&sample).expect("a range"));
        }
        link
    })
}

const NOW_US: u64 = 10_000_000;
const OLD_US: u64 = NOW_US - 1_000_001;

/// Health of a tag in the middle of the anchors at this speed (m/s), with a standard deviation of 10 cm.
fn in_the_middle(config: &Config<f64>, links: &[Link<f64>], speed: f64) -> Health<f64> {
    with_common(Common::NONE, config, links, speed)
}

fn with_common(
    common: Common<f64>,
    config: &Config<f64>,
    links: &[Link<f64>],
    speed: f64,
) -> Health<f64> {
    let speed_squared = speed * speed;
    let place =
        Place { position: vector![0.0, 0.0], variance: 0.01, speed_squared, mirror: None, common };
    let mut counters = Counters::new();
    counters.begun();
    health((&counters, config), (links, &Pace::new(4)), Some(place), NOW_US, false)
}

fn is_near(found: f64, expected: f64) -> bool {
    (found / expected - 1.0).abs() < 1e-3
}

/// Sets the learnt variance of an anchor's ranges, m².
fn learnt(links: &mut [Link<f64>], index: usize, variance: f64) {
    links[index].noise = MeasurementNoise::new(variance);
}

#[test]
fn four_anchors_around_a_tag_leave_it_the_constant_error_of_one() {
    let config = Config { range_sigma: 0.05, ..Config::uncalibrated(1.0) };
    let links = links(&config, [Some(NOW_US); 4]);
    let health = in_the_middle(&config, &links, 10.0);
    assert_eq!((health.state, health.heard), (State::Tracking, 4));
    assert!(is_near(health.dilution.expect("four anchors"), 1.0), "{health:?}");
    assert!(is_near(health.bias_sigma, 0.1), "{health:?}");
    assert!(is_near(health.position_sigma.expect("a place"), 0.1 * 2_f64.sqrt()), "{health:?}");
    // While it stands, its surroundings contribute as much again; at 10 cm/s half of that.
    assert!(is_near(in_the_middle(&config, &links, 0.0).bias_sigma, 0.1 * 2_f64.sqrt()));
    assert!(is_near(in_the_middle(&config, &links, 0.1).bias_sigma, 0.1 * 1.5_f64.sqrt()));
    let plain = Config::plain(1.0);
    assert_eq!(in_the_middle(&plain, &links, 0.0).bias_sigma, 0.0);
}

#[test]
fn what_was_learnt_of_ranges_beyond_their_noise_stays_where_a_tag_stands() {
    let config = Config { range_sigma: 0.05, ..Config::uncalibrated(1.0) };
    let mut links = links(&config, [Some(NOW_US); 4]);
    for index in 0..4 {
        learnt(&mut links, index, 0.01 + 0.02);
    }
    // While moving, it averages out as far as it is the usual range noise.
    let usual = Config { range_sigma: 0.03_f64.sqrt(), ..config };
    assert!(is_near(in_the_middle(&usual, &links, 100.0).bias_sigma, 0.1));
    assert!(is_near(in_the_middle(&config, &links, 100.0).bias_sigma, 0.03_f64.sqrt()));
    assert!(is_near(in_the_middle(&config, &links, 0.0).bias_sigma, 0.2));
    // Three good ones determine the position as if the poor one, 50 times worse, hardly existed.
    for index in 0..4 {
        learnt(&mut links, index, if index == 0 { 49.0 * 0.02 + 0.01 + 0.02 - 0.02 } else { 0.0 });
    }
    let standing = in_the_middle(&config, &links, 0.0);
    let along = 1.0 + 0.02;
    let expected = (0.02 * (1.0 / along + 0.5)).sqrt();
    assert!(is_near(standing.bias_sigma, expected), "{standing:?} {expected}");
}

#[test]
fn a_link_that_is_hopeless_counts_a_thousandth() {
    let config = Config { range_sigma: 0.05, ..Config::uncalibrated(1.0) };
    let mut links = links(&config, [Some(NOW_US), Some(NOW_US), None, None]);
    learnt(&mut links, 0, 1e6);
    learnt(&mut links, 1, 0.0);
    let standing = in_the_middle(&config, &links, 0.0);
    assert!(is_near(standing.bias_sigma, (0.02 * 1001.0_f64).sqrt()), "{standing:?}");
}

#[test]
fn where_those_heard_are_too_few_a_position_keeps_what_all_made_of_it() {
    let config = Config { range_sigma: 0.05, ..Config::uncalibrated(1.0) };
    let too_few = links(&config, [Some(NOW_US), Some(OLD_US), Some(OLD_US), Some(OLD_US)]);
    let health = in_the_middle(&config, &too_few, 10.0);
    assert_eq!((health.state, health.heard, health.dilution), (State::Tracking, 1, None));
    assert!(is_near(health.bias_sigma, 0.1), "{health:?}");
    let none = links(&config, [Some(OLD_US); 4]);
    let health = in_the_middle(&config, &none, 10.0);
    assert_eq!((health.state, health.heard), (State::Coasting, 0));
    assert!(is_near(health.bias_sigma, 0.1), "{health:?}");
    let never = links(&config, [Some(NOW_US), None, None, None]);
    assert_eq!(in_the_middle(&config, &never, 10.0).bias_sigma, 0.0);
    let mut blocked = links(&config, [Some(NOW_US); 4]);
    blocked[2].is_blocked = true;
    assert_eq!(count_heard(&blocked, &Pace::new(4), NOW_US), 3);
}

#[test]
fn a_common_bias_that_is_not_told_moves_a_tag_that_anchors_are_not_around() {
    let config = Config { range_sigma: 0.05, ..Config::uncalibrated(1.0) };
    let common = Common { sigma: 0.3, shape: [1.0, 0.0] };
    // With ranges of this noise (m²), or none, the residuals show no bias, or one as large as they are.
    let found = |places, common, noise| {
        let mut links = links_at(places, &config, [Some(NOW_US); 3]);
        for index in 0..3 {
            learnt(&mut links, index, noise);
        }
        with_common(common, &config, &links, 100.0).bias_sigma
    };
    // Around the tag they leave no error, in whatever direction.
    let around = [[5.0, 0.0, 1.0], [-2.5, 4.330_127, 1.0], [-2.5, -4.330_127, 1.0]];
    let own = |places, noise| found(places, Common::NONE, noise);
    assert!(is_near(found(around, common, 1e4), own(around, 1e4)));
    // 60° to the left, ahead and 60° to the right, they shift it by (0.3 m) 2 / (1 + 2 cos² 60°) = 0.4 m.
    let ahead = [[5.0, 0.0, 1.0], [2.5, 4.330_127, 1.0], [2.5, -4.330_127, 1.0]];
    assert!(is_near(found(ahead, common, 1e4), own(ahead, 1e4).hypot(0.4)));
    // A third of its square would remain in the residuals.
    let (bias, noise) = (0.09_f64, 0.0025);
    let seen = 0.4 * (noise / (noise + bias / 3.0)).sqrt();
    assert!(is_near(found(ahead, common, noise), own(ahead, noise).hypot(seen)));
    // In proportion to the distance, it is twice as large for an anchor at twice the distance, which shifts the tag by
    // (0.3 m) / 1.5 = 0.2 m.
    let slope = Common { sigma: 0.3, shape: [0.0, 0.2] };
    let far = [[10.0, 0.0, 1.0], around[1], around[2]];
    assert!(is_near(found(far, slope, 1e4), own(far, 1e4).hypot(0.2)));
}

#[test]
fn a_tag_is_lost_that_had_a_position() {
    let config = Config::uncalibrated(1.0);
    let links = links(&config, [Some(NOW_US); 4]);
    let mut counters = Counters::new();
    let health = |counters: &Counters<f64>| {
        let place = None::<Place<f64, 2>>;
        health((counters, &config), (&links, &Pace::new(4)), place, NOW_US, true)
    };
    let before = health(&counters);
    assert_eq!((before.state, before.restarts, before.still), (State::Initialising, 0, true));
    assert_eq!((before.dilution, before.position_sigma, before.bias_sigma), (None, None, 0.0));
    counters.begun();
    counters.begun();
    assert_eq!((health(&counters).state, health(&counters).restarts), (State::Lost, 1));
    // Two for each rejected range: with four anchors a third one is too many.
    counters.reject(4, false);
    counters.reject(4, false);
    assert!(!health(&counters).distrusted);
    counters.reject(4, false);
    assert!(health(&counters).distrusted);
}

#[test]
fn where_the_good_ones_do_not_tell_a_place_all_count_alike() {
    let config = Config { range_sigma: 0.05, ..Config::uncalibrated(1.0) };
    // A good anchor ahead, and a hopeless one in nearly the same direction.
    let places = [[5.0, 0.0, 1.0], [5.0, 0.5, 1.0]];
    let mut links = links_at(places, &config, [Some(NOW_US); 2]);
    learnt(&mut links, 1, 1e6);
    let health = in_the_middle(&config, &links, 0.0);
    let dilution = health.dilution.expect("two directions");
    assert!(dilution > 10.0 && is_near(health.bias_sigma, 0.1 * dilution), "{health:?}");
}
