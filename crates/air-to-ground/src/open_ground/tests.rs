extern crate std;

use std::vec::Vec;

use kestirim_scalar::{Q16_16, Scalar};

use super::{OpenGround, Pattern, SUPPOSITIONS, Supposition, ceiling, quantile};
use crate::{Heading, LevelPrior, Measurement};

const TRUTH: [f64; 2] = [30.0, -20.0];

/// Ten lines of ten measurements each, with a little deterministic noise.
fn flight<T: Scalar>(exponent: f64, change: impl Fn(f64) -> f64) -> Vec<Measurement<T>> {
    let stop = |k: u32| {
        let at = [f64::from(k % 10) * 25.0 - 110.0, f64::from(k / 10) * 25.0 - 110.0];
        let horizontal = (at[0] - TRUTH[0]).hypot(at[1] - TRUTH[1]);
        let distance = horizontal.hypot(40.0);
        let noise = f64::from(k * 7919 % 13) / 6.0 - 1.0;
        let level = change(-20.0 - 10.0 * exponent * distance.log10()) + noise;
        let numbers = (at.map(T::from_f64), T::from_f64(40.0), T::from_f64(-level));
        Measurement::new(numbers.0, numbers.1, numbers.2).expect("plausible")
    };
    (0..100).map(stop).collect()
}

fn suppositions<T: Scalar>(
    channel: &OpenGround<T>,
    flight: &[Measurement<T>],
    headings: &[Heading<T>],
) -> Vec<Supposition<T>> {
    channel.suppositions(flight, headings).collect()
}

/// Log-likelihood of the true place minus that of another.
fn advantage<T: Scalar>(flight: &[Measurement<T>], place: [f64; 2]) -> f64 {
    let channel = OpenGround::new(None);
    let suppositions = suppositions(&channel, flight, &[]);
    let log = |place: [f64; 2]| {
        let place = place.map(T::from_f64);
        channel.log_likelihood(flight, &[], place, T::ONE, &suppositions, |_, _| ()).to_f64()
    };
    log(TRUTH) - log(place)
}

fn check<T: Scalar>() {
    for exponent in [1.0, 2.0, 3.0] {
        let clean = flight::<T>(exponent, |level| level);
        let drowned = flight::<T>(exponent, |level| level.max(-20.0 - exponent * 20.0));
        for flight in [&clean, &drowned] {
            for place in [[70.0, -20.0], [30.0, 20.0], [-90.0, 80.0]] {
                let advantage = advantage(flight, place);
                assert!(advantage > 1.0, "{exponent}, {place:?}: {advantage}");
            }
        }
        let channel = OpenGround::new(None);
        let suppositions = suppositions(&channel, &clean, &[]);
        let fit = channel.fit(&clean, &[], TRUTH.map(T::from_f64), &suppositions[0], T::ONE);
        assert!((fit.exponent.to_f64() - exponent).abs() < 0.3, "{fit:?}");
        assert!((fit.level.to_f64() + 20.0).abs() < 6.0, "{fit:?}");
    }
}

#[test]
fn the_true_place_is_likelier_whatever_the_exponent_and_the_floor() {
    check::<f32>();
    check::<f64>();
    check::<Q16_16>();
}

#[test]
fn a_known_level_tells_the_exponent_and_evidence_falls_where_it_is_wrong() {
    let flight = flight::<f64>(2.0, |level| level);
    let fit = |mean| {
        let channel = OpenGround::new(Some(LevelPrior { mean, sigma: 1.0 }));
        let suppositions = suppositions(&channel, &flight, &[]);
        channel.fit(&flight, &[], TRUTH, &suppositions[0], 1.0)
    };
    let (right, wrong) = (fit(-20.0), fit(-50.0));
    assert!((right.exponent - 2.0).abs() < 0.05 && (right.level + 20.0).abs() < 1.0, "{right:?}");
    assert!(right.log_evidence > wrong.log_evidence + 5.0, "{right:?} {wrong:?}");
}

/// A clean flight predicts measurements elsewhere; a floor and a ceiling bound them.
fn foretold<T: Scalar>() {
    let flight = flight::<T>(2.0, |level| level);
    let channel = OpenGround::new(None);
    let isotropic = suppositions(&channel, &flight, &[])[0];
    let fit = channel.fit(&flight, &[], TRUTH.map(T::from_f64), &isotropic, T::ONE);
    let at = |supposition: &Supposition<T>, far: f64| {
        let waypoint = [TRUTH[0] + far, TRUTH[1]].map(T::from_f64);
        let place = TRUTH.map(T::from_f64);
        let (level, sigma) = fit.expected(supposition, place, waypoint, T::from_f64(40.0));
        (level.to_f64(), sigma.to_f64())
    };
    for far in [10.0, 100.0, 300.0_f64] {
        let known = -20.0 - 20.0 * far.hypot(40.0).log10();
        let (level, sigma) = at(&isotropic, far);
        assert!((level - known).abs() < 1.0, "{far}: {level} {known}");
        // A scale of 1.2 dB with ν = 4, combined with 1.7 dB.
        assert!((sigma - (2.0_f64 * 1.2 * 1.2 + 1.7 * 1.7).sqrt()).abs() < 0.01, "{sigma}");
    }
    let tilted = Supposition { pattern: Pattern::Tilted, ..isotropic };
    assert!(at(&tilted, 100.0).1 > 4.4, "an unknown pattern is noise");
    let turned = Supposition { pattern: Pattern::Turned, ..isotropic };
    assert!(at(&turned, 100.0).1 > at(&tilted, 100.0).1, "and so is one that turns");
    let floor = Supposition { floor: Some(T::from_f64(-50.0)), ..isotropic };
    let (level, sigma) = at(&floor, 300.0);
    assert!((level + 50.0).abs() < 0.3 && sigma < 1.8, "drowned: {level} ± {sigma}");
    let ceiling = Supposition { ceiling: Some(T::from_f64(-60.0)), ..isotropic };
    assert!((at(&ceiling, 0.0).0 + 60.0).abs() < 0.01, "saturated");
}

#[test]
fn a_further_measurement_is_foretold() {
    foretold::<f32>();
    foretold::<f64>();
    foretold::<Q16_16>();
}

#[test]
fn a_floor_is_supposed_where_levels_are_and_a_ceiling_where_they_are_alike() {
    let flight = flight::<f64>(2.0, |level| level);
    assert_eq!(ceiling(&flight), None);
    let mut levels: Vec<f64> = flight.iter().map(|measurement| -measurement.loss()).collect();
    levels.sort_by(f64::total_cmp);
    assert_eq!(quantile(&flight, 0.1), Some(levels[9]));
    assert_eq!(quantile(&flight, 0.65), Some(levels[64]));
    assert_eq!(quantile::<f64>(&[], 0.5), None);
    let strongest = Measurement::new([0.0; 2], 40.0, 10.0).expect("plausible");
    assert_eq!(ceiling(&[strongest; 3]), None);
    let saturated: Vec<_> = flight.iter().copied().chain([strongest; 4]).collect();
    assert_eq!(ceiling(&saturated), Some(-10.0));
    let suppositions = suppositions(&OpenGround::new(None), &saturated, &[]);
    assert_eq!(suppositions.len(), SUPPOSITIONS / 4 * 3, "no heading is known");
    assert!(suppositions.iter().all(|it| it.ceiling == Some(-10.0)));
    let all: f64 = suppositions.iter().map(|it| it.log_prior.exp()).sum();
    assert!((all - 3.0).abs() < 1e-9, "as many as scales: {all}");
}

#[test]
fn nothing_and_too_much_are_borne() {
    let channel = OpenGround::new(None);
    let suppositions = suppositions(&channel, &[], &[]);
    let log = channel.log_likelihood(&[], &[], [0.0; 2], 1.0, &suppositions, |_, _| ());
    assert!(log.is_finite());
    let all: Vec<_> = (0..2).flat_map(|_| flight::<f64>(2.0, |level| level)).collect();
    let first = channel.fit(&all, &[], TRUTH, &suppositions[1], 1.0);
    assert_eq!(first, channel.fit(&all[..128], &[], TRUTH, &suppositions[1], 1.0));
}

/// An antenna on a drone that turns by 40° between places: 8 dB more gain to the front than to the back.
fn check_turned<T: Scalar>() {
    let angle = |k: usize| 40.0_f64.to_radians() * k as f64 % core::f64::consts::TAU;
    let turned = |(k, measurement): (usize, &Measurement<T>)| {
        let [x, y] = measurement.place().map(T::to_f64);
        let (sine, cosine) = angle(k).sin_cos();
        let [east, north] = [x - TRUTH[0], y - TRUTH[1]];
        let forward = (east * sine + north * cosine) / east.hypot(north).hypot(40.0);
        let loss = measurement.loss().to_f64() - 4.0 * forward;
        Measurement::new(measurement.place(), measurement.height(), T::from_f64(loss)).expect("one")
    };
    let flight: Vec<_> = flight::<T>(2.0, |level| level).iter().enumerate().map(turned).collect();
    let heading = |sign: f64, k| Heading::new(T::from_f64(sign * angle(k))).expect("finite");
    let channel = OpenGround::new(None);
    let best = |headings: &[Heading<T>], is_turned: bool| {
        let all = suppositions(&channel, &flight, headings);
        let of_kind = all.iter().filter(|it| (it.pattern == Pattern::Turned) == is_turned);
        let fit = |it: &Supposition<T>| {
            channel.fit(&flight, headings, TRUTH.map(T::from_f64), it, T::ONE)
        };
        let log = |it: &Supposition<T>| (fit(it).log_evidence + it.log_prior).to_f64();
        of_kind.map(log).fold(f64::NEG_INFINITY, f64::max)
    };
    let headings: Vec<_> = (0..flight.len()).map(|k| heading(1.0, k)).collect();
    let mirrored: Vec<_> = (0..flight.len()).map(|k| heading(-1.0, k)).collect();
    let all = suppositions(&channel, &flight, &headings);
    assert_eq!(all.len(), SUPPOSITIONS);
    let nearly: Vec<_> = (0..100).map(|k| heading(0.01, k % 9)).collect();
    let of_nearly = suppositions(&channel, &flight, &nearly);
    assert_eq!(of_nearly, suppositions(&channel, &flight, &[]), "always much the same way");
    let total: f64 = all.iter().map(|it| it.log_prior.to_f64().exp()).sum();
    assert!((total - 3.0).abs() < 0.01, "as many as scales: {total}");
    let [with, without, wrong] = [(&headings, true), (&headings, false), (&mirrored, true)]
        .map(|(headings, is_turned)| best(headings, is_turned));
    assert!(with > without + 20.0, "{with} {without}");
    assert!(with > wrong + 20.0, "anticlockwise headings: {with} {wrong}");
    // The callback of `log_likelihood` receives what `fit` finds, in the order of the suppositions.
    let (mut told, place) = (std::vec![T::ZERO; all.len()], TRUTH.map(T::from_f64));
    let log = |index, log| told[index] = log;
    channel.log_likelihood(&flight, &headings, place, T::ONE, &all, log);
    for (supposition, told) in all.iter().zip(told) {
        let fit = channel.fit(&flight, &headings, place, supposition, T::ONE);
        assert_eq!(fit.log_evidence + supposition.log_prior, told, "{supposition:?}");
    }
}

#[test]
fn an_antenna_that_turns_with_the_drone_is_likelier_where_headings_are_known() {
    check_turned::<f32>();
    check_turned::<f64>();
    check_turned::<Q16_16>();
}

/// Feature `vectors` fits several suppositions side by side, which gives what one after the other does.
#[test]
fn fits_side_by_side_are_those_of_one_at_a_time() {
    let flight = flight::<f64>(2.0, |level| level.clamp(-62.0, -48.0));
    let headings: Vec<_> =
        (0..100).map(|k| Heading::new(f64::from(k) * 0.7).expect("finite")).collect();
    let channel = OpenGround::new(None);
    let mut all = suppositions(&channel, &flight, &headings);
    assert_eq!(all.len(), SUPPOSITIONS);
    for supposition in &mut all {
        supposition.ceiling = Some(-52.0);
    }
    // As after the unlikely ones have been left out: one, two and more of a pattern.
    for _ in 0..3 {
        let mut count = 0;
        channel.log_likelihood(&flight, &headings, [70.0, 5.0], 0.5, &all, |index, log| {
            let fit = channel.fit(&flight, &headings, [70.0, 5.0], &all[index], 0.5);
            assert_eq!(log, fit.log_evidence + all[index].log_prior, "{:?}", all[index]);
            assert_eq!(index, count, "in their order");
            count += 1;
        });
        assert_eq!(count, all.len());
        let mut number = 0;
        all.retain(|_| {
            number += 1;
            number % 5 == 1 || number % 7 == 2
        });
    }
}
