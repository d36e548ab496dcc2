//! The height of a tag from its ranges: found, distinguished as far as possible, and with an honest uncertainty.

use crate::common::{CORNERS, anchors, distance, sample};
use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_ranging::{Error as NoPlace, Height, HeightSearch};
use kestirim_uwb_tracker::{Error, HeightFinder, RangeSample};
use nalgebra::{SVector, Vector3};
use proptest::prelude::*;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

/// Normally distributed numbers of mean 0 and standard deviation 1.
fn normal(seed: u64) -> impl FnMut() -> f64 {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    move || StandardNormal.sample(&mut random)
}

/// The corners of a room of 6 m × 5 m, all at one height.
fn corners(height: f64) -> [[f64; 3]; 4] {
    [[0.0, 0.0, height], [6.0, 0.0, height], [6.0, 5.0, height], [0.0, 5.0, height]]
}

/// Duration of a round through the room, s.
const ROUND_S: f64 = 60.0;

fn on_the_round(seconds: f64) -> [f64; 2] {
    let (sin, cos) = (seconds * std::f64::consts::TAU / ROUND_S).sin_cos();
    [3.0 + 2.4 * cos, 2.5 + 1.9 * sin]
}

/// Feeds the ranges of a tag on the round, ten times per second: each link has an error of its own (`link`, m) that
/// changes from place to place.
fn round<T: Scalar>(
    finder: &mut HeightFinder<T, 4>,
    places: &[[f64; 3]],
    height: f64,
    biases: &[f64],
    link: f64,
    seed: u64,
) {
    let mut random = normal(seed);
    let mut errors = vec![0.0; places.len()];
    for epoch in 0..600_u32 {
        let seconds = 0.1 * f64::from(epoch);
        let [x, y] = on_the_round(seconds);
        for (index, place) in places.iter().enumerate() {
            // The tag moves by 30 cm in 1.3 s, after which errors change.
            if epoch % 13 == 0 {
                errors[index] = link * random();
            }
            let range = distance(*place, [x, y, height]) + biases[index] + errors[index];
            let time_us = u64::from(epoch) * 100_000;
            finder.range(&sample(time_us, index, range + 0.02 * random())).unwrap();
        }
    }
    finder.end_place();
}

fn found<T: Scalar>(
    places: &[[f64; 3]],
    height: f64,
    biases: &[f64],
    link: f64,
    seed: u64,
) -> Height<f64, 4> {
    let mut finder = HeightFinder::<T, 4>::uncalibrated(&anchors(places, 0.0)).unwrap();
    round(&mut finder, places, height, biases, link, seed);
    let found = finder.height().expect("a height");
    Height {
        metres: found.metres.to_f64(),
        sigma: found.sigma.to_f64(),
        position_sigma: found.position_sigma.to_f64(),
        biases: found.biases.map(T::to_f64),
    }
}

#[test]
fn a_low_tag_among_high_anchors_in_every_number() {
    let biases = [0.15, 0.22, 0.1, 0.18];
    let heights = [
        found::<f64>(&corners(2.5), 0.6, &biases, 0.03, 1),
        found::<f32>(&corners(2.5), 0.6, &biases, 0.03, 1),
        found::<Q12_20>(&corners(2.5), 0.6, &biases, 0.03, 1),
    ];
    for height in heights {
        assert!((height.metres - 0.6).abs() < 2.5 * height.sigma, "{height:?}");
        assert!(height.sigma < 0.6 && height.position_sigma < 0.12, "{height:?}");
        assert!((height.metres - heights[0].metres).abs() < 0.02, "{height:?}");
    }
}

#[test]
fn three_anchors_will_do() {
    // The anchors of a published recording, in its room of three metres.
    let places = [[5.0, 0.0, 1.3], [0.1, 0.5, 2.0], [3.0, 5.0, 2.1]];
    let height = found::<f32>(&places, 0.1, &[0.1, 0.05, 0.12], 0.03, 4);
    assert!((height.metres - 0.1).abs() < 2.5 * height.sigma, "{height:?}");
    assert_eq!(height.biases[3], 0.0, "of the anchor that is not there");
}

#[test]
fn calibrated_anchors_tell_it_better() {
    let places = corners(2.5);
    let mut finder = HeightFinder::<f32, 4>::calibrated(&anchors(&places, 0.2)).unwrap();
    round(&mut finder, &places, 0.6, &[0.2; 4], 0.03, 2);
    let height = finder.height().unwrap();
    let as_they_come = found::<f32>(&places, 0.6, &[0.2; 4], 0.03, 2);
    assert!((height.metres - 0.6).abs() < 2.5 * height.sigma, "{height:?}");
    assert!(f64::from(height.sigma) < 0.7 * as_they_come.sigma, "{height:?} {as_they_come:?}");
}

#[test]
fn of_mirror_images_the_lower_is_taken_and_moves_nothing() {
    // 0.3 and 1.9 m are equally far from anchors at 1.1 m: both give the same ranges.
    let places = corners(1.1);
    for truth in [0.3, 1.9] {
        let mut finder = HeightFinder::<f64, 4>::calibrated(&anchors(&places, 0.0)).unwrap();
        round(&mut finder, &places, truth, &[0.0; 4], 0.01, 3);
        let height = finder.height().unwrap();
        assert!((height.metres - 0.3).abs() < 2.5 * height.sigma, "{truth}: {height:?}");
        assert!(height.metres + height.sigma < 1.1 && height.position_sigma < 0.05, "{height:?}");
    }
    // Anchors at different heights distinguish above from below.
    for truth in [0.4, 1.8] {
        let height = found::<f64>(&CORNERS, truth, &[0.0; 4], 0.01, 3);
        assert!((height.metres - truth).abs() < 2.5 * height.sigma, "{truth}: {height:?}");
        assert!(height.sigma < 0.2, "{truth}: {height:?}");
    }
}

#[test]
fn above_anchors_on_the_floor_there_is_no_below() {
    let height = found::<f64>(&corners(0.0), 1.0, &[0.05; 4], 0.02, 5);
    assert!((height.metres - 1.0).abs() < 2.5 * height.sigma, "{height:?}");
}

#[test]
fn beside_anchors_of_its_own_height_it_is_unknown_and_does_not_matter() {
    let height = found::<f64>(&corners(1.0), 1.0, &[0.1; 4], 0.05, 6);
    assert!((height.metres - 1.0).abs() < 2.5 * height.sigma, "{height:?}");
    assert!(height.sigma > 0.2 && height.position_sigma < 0.06, "{height:?}");
}

/// The height of a stationary tag.
fn standing(places: &[[f64; 3]], tag: [f64; 3]) -> Height<f64, 4> {
    let mut finder = HeightFinder::<f64, 4>::uncalibrated(&anchors(places, 0.0)).unwrap();
    for epoch in 0..100_u64 {
        for (index, place) in places.iter().enumerate() {
            let range = distance(*place, tag);
            assert_eq!(finder.range(&sample(epoch * 100_000, index, range)), Ok(false));
        }
    }
    assert!(finder.height().is_none(), "the place has not been left");
    finder.end_place();
    finder.height().expect("a height")
}

#[test]
fn a_tag_that_stands_beyond_three_anchors_is_not_told_its_height() {
    let height = standing(&[[2.8, 0.0, 1.3], [0.1, 0.0, 2.0], [1.9, 4.1, 2.1]], [3.5, 4.7, 0.0]);
    assert!(height.sigma > 0.3 && height.position_sigma > 0.15, "{height:?}");
    // In the middle of four anchors the height is as uncertain, but has less effect.
    let height = standing(&corners(2.0), [3.0, 2.5, 0.2]);
    assert!(height.sigma > 0.3 && height.position_sigma < 0.02, "{height:?}");
}

#[test]
fn the_deviation_is_honest() {
    let mut within = [0_u32; 2];
    let runs = 60;
    for seed in 1..=runs {
        let mut random = normal(1000 + u64::from(seed));
        let top = 2.0 + 0.3 * random();
        let mut places = corners(top.max(1.2));
        for place in &mut places {
            *place = place.map(|coordinate| coordinate + 0.3 * random());
        }
        let common = 0.2 * random();
        let biases: Vec<f64> = places.iter().map(|_| common + 0.1 * random()).collect();
        let truth = 0.5 + 0.2 * random().clamp(-2.0, 2.0);
        let height = found::<f64>(&places, truth, &biases, 0.07, seed.into());
        for (within, factor) in within.iter_mut().zip([1.0, 2.5]) {
            *within += u32::from((height.metres - truth).abs() <= factor * height.sigma);
        }
    }
    println!("{within:?} of {runs} within 1 and 2.5 σ");
    assert!(10 * within[1] >= 9 * runs && 2 * within[0] >= runs, "{within:?}");
    // It is no larger than necessary either.
    assert!(within[0] < runs, "{within:?}");
}

#[test]
fn ranges_one_by_one_and_wild_ones() {
    let places = corners(2.5);
    let mut finder = HeightFinder::<f32, 4>::uncalibrated(&anchors(&places, 0.0)).unwrap();
    let (mut random, mut places_ended) = (normal(7), 0);
    for k in 0..2400_u32 {
        let seconds = 0.025 * f64::from(k);
        let [x, y] = on_the_round(seconds);
        let index = (k % 4) as usize;
        let range = if k % 20 == 7 {
            [60.0, 0.2, 150.0][(k / 20 % 3) as usize]
        } else {
            distance(places[index], [x, y, 0.6]) + 0.1 + 0.03 * random()
        };
        let ended = finder.range(&sample(u64::from(k) * 25_000, index, range)).unwrap();
        places_ended += u32::from(ended);
    }
    let height = finder.height().unwrap();
    assert!((height.metres - 0.6).abs() < 2.5 * height.sigma && height.sigma < 0.5, "{height:?}");
    assert!((15..60).contains(&places_ended), "{places_ended}");
}

#[test]
fn moments_may_be_seconds_apart() {
    let places = corners(2.5);
    let mut finder = HeightFinder::<f32, 4>::calibrated(&anchors(&places, 0.0)).unwrap();
    for epoch in 0..20_u32 {
        let [x, y] = on_the_round(3.0 * f64::from(epoch));
        for (index, place) in places.iter().enumerate() {
            let range = distance(*place, [x, y, 0.6]);
            finder.range(&sample(u64::from(epoch) * 3_000_000, index, range)).unwrap();
        }
    }
    finder.end_place();
    let height = finder.height().unwrap();
    assert!((height.metres - 0.6).abs() < 2.5 * height.sigma && height.sigma < 0.3, "{height:?}");
}

#[test]
fn what_cannot_be_used_is_refused() {
    let new = |places: &[[f64; 3]]| HeightFinder::<f32, 4>::uncalibrated(&anchors(places, 0.0));
    assert_eq!(new(&corners(1.0)[..2]).unwrap_err(), Error::TooFewAnchors);
    assert_eq!(new(&[[0.0; 3]; 5]).unwrap_err(), Error::TooManyAnchors);
    assert_eq!(new(&[[f64::NAN; 3]; 3]).unwrap_err(), Error::NotFinite);
    let mut finder = new(&corners(1.0)).unwrap();
    let mut give = |time_us, anchor, range| finder.range(&sample(time_us, anchor, range));
    assert_eq!(give(10, 0, 3.0), Ok(false));
    assert_eq!(give(10, 0, 3.0), Err(Error::Duplicate));
    assert_eq!(give(9, 0, 3.0), Err(Error::OutOfOrder));
    assert_eq!(give(20, 4, 3.0), Err(Error::NoSuchAnchor));
    assert_eq!(give(20, 0, 300.0), Err(Error::ImplausibleRange));
    assert_eq!(give(20, 0, f64::NAN), Err(Error::NotFinite));
    finder.end_place();
    finder.end_place();
    assert!(finder.height().is_none());

    let places = corners(1.0).map(|place| Vector3::from(place.map(|it| it as f32)));
    let search = |places: &[SVector<f32, 3>], own| HeightSearch::<f32, 4>::new(places, 0.3, own);
    assert_eq!(search(&places[..2], 0.1).unwrap_err(), NoPlace::TooFewRanges);
    assert_eq!(search(&places, 0.0).unwrap_err(), NoPlace::NotPositive);
    assert_eq!(search(&places, f32::NAN).unwrap_err(), NoPlace::NotFinite);
    let mut search = search(&places, 0.1).unwrap();
    assert_eq!(search.add(&[Some(3.0), Some(4.0), None, None]), Err(NoPlace::TooFewRanges));
    assert_eq!(search.add(&[Some(f32::NAN); 4]), Err(NoPlace::NotFinite));
    assert_eq!(search.places(), 0.0);
}

#[test]
fn anchors_in_a_line_tell_nothing() {
    let line = [[0.0, 0.0, 2.0], [3.0, 0.0, 2.0], [6.0, 0.0, 2.0]];
    let mut finder = HeightFinder::<f64, 4>::uncalibrated(&anchors(&line, 0.0)).unwrap();
    round(&mut finder, &line, 0.5, &[0.0; 3], 0.03, 9);
    // The tag's distance from the line may be a height or a distance in the plane.
    let height = finder.height();
    assert!(height.is_none_or(|height| height.sigma > 0.3), "{height:?}");
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => 0.0..12.0_f64,
        1 => -300.0..1000.0_f64,
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(1e30), Just(-1.0), Just(0.0)],
    ]
}

fn later() -> impl Strategy<Value = i64> {
    prop_oneof![
        4 => Just(0_i64),
        8 => 0..100_000_i64,
        1 => -2_000_000..20_000_000_i64,
        1 => Just(i64::MAX),
    ]
}

fn feed<T: Scalar>(
    places: &[[f64; 3]],
    samples: &[(i64, usize, f64)],
) -> Result<(), TestCaseError> {
    let Ok(mut finder) = HeightFinder::<T, 4>::uncalibrated(&anchors(places, 0.0)) else {
        return Ok(());
    };
    let mut now_us = 1_000_000_u64;
    for &(later_us, anchor, range) in samples {
        let before = format!("{finder:?}");
        now_us = now_us.saturating_add_signed(later_us);
        let range = T::from_f64(range);
        if finder.range(&RangeSample { time_us: now_us, anchor, range }).is_err() {
            prop_assert_eq!(before, format!("{:?}", finder), "refused, and changed");
        }
        if anchor == 4 {
            finder.end_place();
        }
    }
    finder.end_place();
    if let Some(height) = finder.height() {
        let numbers = [height.metres, height.sigma, height.position_sigma];
        prop_assert!(numbers.iter().chain(&height.biases).all(|number| number.is_finite()));
        prop_assert!(height.sigma >= T::ZERO && height.position_sigma >= T::ZERO);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn anything_gives_a_height_or_none(
        places in proptest::collection::vec([-20.0..20.0_f64, -20.0..20.0, -3.0..5.0], 3..=4),
        samples in proptest::collection::vec((later(), 0_usize..5, number()), 0..120),
    ) {
        feed::<f64>(&places, &samples)?;
        feed::<f32>(&places, &samples)?;
        feed::<Q12_20>(&places, &samples)?;
    }
}
