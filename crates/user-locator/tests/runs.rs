//! Runs of broken measurements among good ones: whatever comes, every estimate is finite, and a user who moves is
//! followed again. `PROPTEST_CASES` sets the number of sequences.

use kestirim_air_to_ground::{Channel, Environment, Measurement};
use kestirim_particle_filter::{Moments, Region, Xoshiro128PlusPlus};
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_user_locator::{Locator, Motion, PublishedLocator, PublishedSettings, Tracker};
use proptest::prelude::*;
use rand_core::{Rng, SeedableRng};

/// What is wrong with a run of measurements.
#[derive(Clone, Copy, Debug)]
enum Fault {
    /// The path loss is always this (dB).
    Constant(f64),
    Stuck,
    Alternating(f64, f64),
    /// Too much or too little by this (dB).
    Offset(f64),
    Noise(f64),
    /// The drone says that it is there (m), or this high.
    Place(f64, f64),
    Height(f64),
    NotFinite,
    Missing,
    /// Backwards.
    Reordered(usize),
    /// The interval is this (s).
    Interval(f64),
}

#[derive(Clone, Copy, Debug)]
struct Run {
    fault: Fault,
    begin: usize,
    length: usize,
}

fn any_run(begin: std::ops::Range<usize>, length: usize) -> impl Strategy<Value = Run> {
    let fault = prop_oneof![
        prop_oneof![Just(0.0), 20.0..200.0, 0.0..30_000.0].prop_map(Fault::Constant),
        Just(Fault::Stuck),
        (40.0..200.0, 40.0..200.0).prop_map(|(a, b)| Fault::Alternating(a, b)),
        (-60.0..60.0).prop_map(Fault::Offset),
        (1.0..100.0).prop_map(Fault::Noise),
        (-30_000.0..30_000.0, -30_000.0..30_000.0).prop_map(|(x, y)| Fault::Place(x, y)),
        prop_oneof![Just(0.0), 1.0..20_000.0].prop_map(Fault::Height),
        Just(Fault::NotFinite),
        Just(Fault::Missing),
        (2_usize..20).prop_map(Fault::Reordered),
        prop_oneof![Just(0.0), 0.0..100.0, 0.0..30_000.0].prop_map(Fault::Interval),
    ];
    (fault, begin, 1..=length).prop_map(|(fault, begin, length)| Run { fault, begin, length })
}

#[derive(Clone, Copy, Debug)]
struct Step {
    interval: f64,
    from: [f64; 2],
    height: f64,
    loss: Option<f64>,
}

/// The user walks along a side of the square at 1.4 m/s.
fn user(k: usize) -> [f64; 2] {
    [300.0 + 1.4 * k as f64, 900.0]
}

/// A measurement a second, from a circle over the square once in two minutes.
fn steps(count: usize, runs: &[Run]) -> Vec<Step> {
    let channel = urban::<f64>();
    let mut noise = Xoshiro128PlusPlus::seed_from_u64(7);
    let mut steps: Vec<Step> = (0..count)
        .map(|k| {
            let angle = k as f64 * std::f64::consts::TAU / 120.0;
            let from = [1000.0 + 667.0 * angle.cos(), 1000.0 + 667.0 * angle.sin()];
            let there = user(k);
            let distance = (there[0] - from[0]).hypot(there[1] - from[1]);
            let expected = channel.path_loss(distance, 800.0).unwrap();
            let coins = f64::from(noise.next_u32().count_ones()) - 16.0;
            let loss =
                expected.line_of_sight_mean + expected.line_of_sight_sigma * 0.5 * coins / 2.83;
            Step { interval: 1.0, from, height: 800.0, loss: Some(loss) }
        })
        .collect();
    for run in runs {
        let end = (run.begin + run.length).min(count);
        let part = &mut steps[run.begin.min(end)..end];
        let Some(first) = part.first().copied() else { continue };
        for (k, step) in part.iter_mut().enumerate() {
            match run.fault {
                Fault::Constant(loss) => step.loss = Some(loss),
                Fault::Stuck => step.loss = first.loss,
                Fault::Alternating(a, b) => step.loss = Some(if k % 2 == 0 { a } else { b }),
                Fault::Offset(by) => step.loss = step.loss.map(|loss| loss + by),
                Fault::Noise(size) => {
                    let by = (k as f64 * 12.9898).sin() * size;
                    step.loss = step.loss.map(|loss| loss + by);
                }
                Fault::Place(x, y) => step.from = [x, y],
                Fault::Height(height) => step.height = height,
                Fault::NotFinite => step.loss = Some(f64::NAN),
                Fault::Missing => step.loss = None,
                Fault::Interval(interval) => step.interval = interval,
                Fault::Reordered(_) => {}
            }
        }
        if let Fault::Reordered(block) = run.fault {
            part.chunks_mut(block).for_each(<[_]>::reverse);
        }
    }
    steps
}

fn urban<T: Scalar>() -> Channel<T> {
    Channel::new(&Environment::urban(), T::from_f64(0.15)).unwrap()
}

fn square<T: Scalar>() -> Region<T, 2> {
    Region::new([T::ZERO; 2], [T::from_f64(2000.0); 2]).unwrap()
}

fn measurement<T: Scalar>(step: &Step) -> Option<Measurement<T>> {
    let number = T::from_f64;
    Measurement::new(step.from.map(number), number(step.height), number(step.loss?)).ok()
}

fn check<T: Scalar>(moments: &Moments<T, 2>, step: &Step, name: &str) {
    let finite = T::all_finite(&moments.mean()) && moments.spread().is_finite();
    assert!(finite, "{name} {step:?}: {:?} {:?}", moments.mean(), moments.spread());
}

fn finite<T: Scalar>(runs: &[Run]) {
    let mut draws = Xoshiro128PlusPlus::seed_from_u64(1);
    let settings = PublishedSettings::thesis();
    let region = square::<T>();
    let mut published = PublishedLocator::<T, 300>::new(urban(), &region, settings, &mut draws);
    let mut locator = Locator::<T, 300, 8>::new(urban(), &region);
    for step in steps(300, runs) {
        let Some(measurement) = measurement::<T>(&step) else { continue };
        let _ = published.measure(&measurement, &mut draws);
        let _ = locator.measure(&measurement);
        check(&published.moments(), &step, "published");
        check(&locator.moments(), &step, "locator");
    }
    follow::<T>(&steps(300, runs), |_, _| {});
}

fn follow<T: Scalar>(steps: &[Step], mut look: impl FnMut(usize, f64)) {
    let mut draws = Xoshiro128PlusPlus::seed_from_u64(2);
    let motion = Motion::people_measured_to(T::ONE);
    let mut tracker = Tracker::<T, 500>::new(urban(), motion, &square(), &mut draws);
    for (k, step) in steps.iter().enumerate() {
        let _ = tracker.predict(T::from_f64(step.interval), &mut draws);
        if let Some(measurement) = measurement::<T>(step) {
            let _ = tracker.measure(&measurement, &mut draws);
        }
        let estimate = tracker.estimate();
        let finite = T::all_finite(&estimate.place)
            && T::all_finite(&estimate.velocity)
            && estimate.spread.is_finite();
        assert!(finite, "{step:?}: {estimate:?}");
        check(&tracker.moments(), step, "tracker");
        let (there, place) = (user(k), estimate.place.map(T::to_f64));
        look(k, (there[0] - place[0]).hypot(there[1] - place[1]));
    }
}

fn cases(short: u32) -> ProptestConfig {
    let mut config = ProptestConfig { failure_persistence: None, ..ProptestConfig::default() };
    if std::env::var_os("PROPTEST_CASES").is_none() {
        config.cases = short;
    }
    config
}

proptest! {
    #![proptest_config(cases(16))]

    #[test]
    fn every_estimate_is_finite(runs in proptest::collection::vec(any_run(0..280, 200), 1..6)) {
        finite::<f32>(&runs);
        finite::<f64>(&runs);
        finite::<Q16_16>(&runs);
    }
}
