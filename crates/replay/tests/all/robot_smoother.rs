//! Smoothed paths of tags.

use kestirim_health::Health;
use kestirim_replay::robot::{
    Dimensions, Epoch, Event, FoundHeight, RangeRow, Sensors, Setup, Trace, Tracked, Unsmoothed,
    Wheels, smooth, track,
};
use proptest::prelude::*;

const ANCHORS: [[f64; 3]; 5] =
    [[0.0, 0.0, 2.0], [8.0, 0.0, 1.0], [8.0, 6.0, 2.0], [0.0, 6.0, 1.0], [4.0, -1.0, 1.5]];
/// The largest number of epochs that are smoothed.
const MOST_EPOCHS: usize = 50_000;
const ERRORS: [f64; 5] = [0.15, -0.1, 0.05, -0.15, 0.1];

fn place(time_s: f64) -> [f64; 2] {
    [4.0 + 2.5 * (0.3 * time_s).cos(), 3.0 + 2.0 * (0.4 * time_s).sin()]
}

/// A round among anchors with errors of their own, and noise of five centimetres that repeats.
fn round() -> Vec<Event> {
    let rows = (0..3000).map(|index: i64| {
        let (anchor, time_us) = ((index % 5) as usize, index / 5 * 100_000);
        let [x, y] = place(time_us as f64 * 1e-6);
        let [ax, ay, az] = ANCHORS[anchor];
        let distance = ((x - ax).powi(2) + (y - ay).powi(2) + (az - 1.0).powi(2)).sqrt();
        let draw = (index as f64 * 12.9898).sin() * 43758.5453;
        let noise = 0.05 * 12_f64.sqrt() * (draw - draw.floor() - 0.5);
        RangeRow { time_us, anchor, range: Some(distance + ERRORS[anchor] + noise) }
    });
    Sensors::ranges(rows.collect()).events()
}

fn rmse(epochs: &[Epoch]) -> f64 {
    let squares = epochs.iter().filter_map(|epoch| {
        let ([x, y, _], [a, b]) = (epoch.position?, place(epoch.time_us as f64 * 1e-6));
        Some((x - a).powi(2) + (y - b).powi(2))
    });
    let squares: Vec<f64> = squares.collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn the_errors_of_anchors_are_found_and_no_longer_in_the_positions() {
    let (setup, events) = (Setup::new(&ANCHORS, 1.0), round());
    let trace = track(&setup, &events).unwrap();
    let parts = [Tracked { events: &events, trace: &trace }];
    let smoothed = smooth(&setup, &parts, false).unwrap();
    let [before, after] = [rmse(&trace.epochs), rmse(&smoothed.parts[0])];
    assert!(after < 0.35 * before && after < 0.04, "{before} {after}");
    let sigma = smoothed.parts[0][300].sigma_m().unwrap();
    assert!((0.3..3.0).contains(&(after / sigma)), "{after} {sigma}");
    // An error common to all anchors may be attributed to each of them.
    let mean = smoothed.biases.iter().map(|[bias, _]| bias).sum::<f64>() / 5.0;
    for ([bias, _], expected) in smoothed.biases.iter().zip(ERRORS) {
        assert!((bias - mean - expected + 0.01).abs() < 0.04, "{:?}", smoothed.biases);
    }
}

/// A driver stamps the ranges of a round one after the other, some microseconds apart.
#[test]
fn epochs_may_be_microseconds_apart() {
    let (setup, events) = (Setup::new(&ANCHORS, 1.0), round());
    let mut rows: Vec<RangeRow> = Vec::new();
    for event in &events {
        let Event::Range(range) = event else { continue };
        let time_us = range.time_us + 5 * (rows.len() % 5) as i64;
        rows.push(RangeRow { time_us, anchor: range.anchor, range: Some(range.metres) });
    }
    let events = Sensors::ranges(rows).events();
    let trace = track(&setup, &events).unwrap();
    let parts = [Tracked { events: &events, trace: &trace }];
    let smoothed = smooth(&setup, &parts, false).unwrap();
    let (error, sigma) = (rmse(&smoothed.parts[0]), smoothed.parts[0][1500].sigma_m().unwrap());
    assert!(error < 0.04 && (0.3..3.0).contains(&(error / sigma)), "{error} {sigma}");
}

#[test]
fn a_height_that_was_found_adds_to_the_deviations() {
    let (setup, events) = (Setup::new(&ANCHORS, 1.0), round());
    let found = FoundHeight {
        metres: 1.0,
        sigma_m: 0.2,
        position_sigma_m: 0.1,
        biases: Vec::new(),
        is_of_ranges: true,
    };
    let sigma = |setup: &Setup| {
        let trace = track(setup, &events).unwrap();
        let parts = [Tracked { events: &events, trace: &trace }];
        smooth(setup, &parts, false).unwrap().parts[0][300].sigma_m().unwrap()
    };
    let [known, found] = [sigma(&setup), sigma(&setup.clone().at(found))];
    assert!((found - known.hypot(0.1)).abs() < 1e-9, "{known} {found}");
}

#[test]
fn what_cannot_be_smoothed_is_said() {
    let setup = Setup::new(&ANCHORS, 1.0);
    let parts = [Tracked { events: &[], trace: &Trace::default() }];
    assert_eq!(smooth(&setup, &parts, false), Err(Unsmoothed::NoPosition));
    let many = vec![
        Epoch {
            time_us: 0,
            position: Some([1.0; 3]),
            spread: Some([0.01, 0.0, 0.01]),
            height_variance: None,
            mirror: None,
            health: Health::GOOD,
        };
        MOST_EPOCHS + 1
    ];
    let ends: Vec<_> = (0..many.len()).map(|k| Event::EpochEnd { time_us: k as i64 }).collect();
    let trace = Trace { epochs: many, ..Trace::default() };
    let parts = [Tracked { events: &ends, trace: &trace }];
    assert_eq!(smooth(&setup, &parts, false), Err(Unsmoothed::TooLong));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// With anchors on top of each other, arbitrary ranges and arbitrary times, the result is a number or a refusal.
    #[test]
    fn whatever_was_measured(
        anchors in prop::collection::vec(prop::array::uniform3(-20.0..20.0_f64), 3..6),
        on_a_line: bool,
        rows in prop::collection::vec(
            (
                0_i64..5_000_000,
                0_usize..7,
                prop_oneof![9 => 0.1..30.0_f64, 1 => any::<f64>()],
            ),
            0..200,
        ),
        speed in -2.0..2.0_f64,
        turn_rate in prop_oneof![-2.0..2.0_f64, -1e3..1e3_f64],
        in_space: bool,
        is_static: bool,
    ) {
        let anchors: Vec<_> =
            anchors.iter().map(|&[x, y, z]| if on_a_line { [x, x, 0.0] } else { [x, y, z] }).collect();
        let mut time_us = 0;
        let mut sensors = Sensors::default();
        for (number, &(step_us, anchor, range)) in rows.iter().enumerate() {
            // Most of them a tenth of a second apart, some at once.
            time_us += if number % 7 == 0 { step_us } else { step_us % 100_000 };
            let range = Some(range);
            sensors.ranges.push(RangeRow { time_us, anchor: anchor % anchors.len(), range });
            if number % 3 == 0 {
                sensors.wheels.push(Wheels { time_us, speed, turn_rate });
            }
        }
        let setup = Setup {
            has_wheels: !in_space,
            dimensions: if in_space { Dimensions::Three } else { Dimensions::Two },
            ..Setup::new(&anchors, 1.0)
        };
        let events = sensors.events();
        let Ok(trace) = track(&setup, &events) else { return Ok(()) };
        let parts = [Tracked { events: &events, trace: &trace }];
        let Ok(smoothed) = smooth(&setup, &parts, is_static) else { return Ok(()) };
        for epoch in &smoothed.parts[0] {
            let [x, y, z] = epoch.position.unwrap();
            prop_assert!((x + y + z).is_finite());
            prop_assert!(epoch.sigma_m().is_some_and(|sigma| sigma.is_finite() && sigma >= 0.0));
        }
        prop_assert!(smoothed.biases.iter().flatten().all(|it| it.is_finite()));
    }
}
