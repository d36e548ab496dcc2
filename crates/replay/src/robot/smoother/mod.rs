//! The whole recording at once: where a tag was, given what was measured before and after.
//!
//! A fixed-interval smoother in the form of nonlinear least squares (Bell, *The iterated Kalman smoother as a Gauss–Newton
//! method*, 1994). Ranges and motion have the tracker's models, but for a velocity that decays more slowly; each anchor's constant error is a parameter of the whole
//! run, and so are the turns' gain and drift of a robot on wheels. Ranges are weighed as Student's distribution has it,
//! with a heavier tail where they are too long; how large their noise is, and how long it lasts, is estimated.

mod free;
mod knots;
mod noise;
mod problem;
mod wheels;

use kestirim_health::{Reason, State};
use kestirim_uwb_tracker::Config;

use self::free::Free;
use self::knots::Knots;
use self::problem::{Problem, Solved};
use self::wheels::Driven;
use super::{Dimensions, Epoch, Event, Setup, Trace};
use crate::metrics::rms;

/// A part of a recording, and what a tracker made of it, from which the smoother begins.
#[derive(Debug, Clone, Copy)]
pub struct Tracked<'a> {
    /// What the sensors said.
    pub events: &'a [Event],
    /// Where the tracker found the tag, and what became of every range.
    pub trace: &'a Trace,
}

/// What a smoother made of a recording.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Smoothed {
    /// Of each part: of a tag that moves, its trace's epochs; of one that was put down, a single one; none of a part in which
    /// the tracker never found it.
    pub parts: Vec<Vec<Epoch>>,
    /// What each anchor measures too long, m, beyond what was known beforehand and what all of them do, with its standard
    /// deviation, m.
    pub biases: Vec<[f64; 2]>,
    /// What all of them measure too long, m, and what more in 10 m of distance, m, each with its standard deviation.
    pub common: [[f64; 2]; 2],
}

/// Why a recording is not smoothed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Unsmoothed {
    /// There is no position to begin with.
    #[error("the tracker found no position to begin with")]
    NoPosition,
    /// The ranges do not tell where the tag was.
    #[error("the ranges do not tell where the tag was")]
    NotObservable,
    /// The positions do not settle.
    #[error("the positions do not settle")]
    NotConverged,
    /// There are more epochs than are smoothed together.
    #[error("it has more than {MOST_KNOTS} epochs")]
    TooLong,
    /// What came out is less certain than the tracker's positions, or the tracker tells no standard deviation.
    #[error("it would be less certain than the tracker is")]
    LessCertain,
    /// What came out contradicts the tracker.
    #[error("it would contradict the tracker by more than twice its standard deviation")]
    Contradicts,
}

/// So many epochs are smoothed together, in about 250 MB with the most anchors.
const MOST_KNOTS: usize = 50_000;
/// By how many of the tracker's standard deviations the smoothed positions may differ from the tracker's, root mean
/// square.
const MOST_SIGMAS: f64 = 2.0;

/// Smooths the parts of a recording together. A static recording is one place a part; else the tag moves.
///
/// # Errors
/// [`Unsmoothed`]: it does not pay, or cannot be relied upon.
pub fn smooth(
    setup: &Setup,
    parts: &[Tracked<'_>],
    is_static: bool,
) -> Result<Smoothed, Unsmoothed> {
    let is_calibrated = setup.biases.is_some();
    let config = if is_calibrated { Config::calibrated } else { Config::uncalibrated };
    let config = setup.tuning.of_the_robust(config(setup.height_m));
    let knots = Knots::new(setup, parts, is_static).ok_or(Unsmoothed::NoPosition)?;
    if knots.points.len() > MOST_KNOTS {
        return Err(Unsmoothed::TooLong);
    }
    let solved = match setup.dimensions {
        Dimensions::Three => {
            Problem::<6, 3, _>::new(setup, &config, &knots, Free::<3, 6>::new(setup, &config))
                .solve()
        }
        Dimensions::Two if setup.is_wheeled() && !is_static => {
            // To which side turns are counted: what is more probable.
            let to_a_side = [1.0, -1.0].map(|side| {
                let motion = Driven::new(parts, &knots, side);
                Problem::<4, 2, _>::new(setup, &config, &knots, motion).solve()
            });
            match to_a_side {
                [Ok(left), Ok(right)] if left.cost <= right.cost => Ok(left),
                [Ok(left), Err(_)] => Ok(left),
                [_, right] => right,
            }
        }
        Dimensions::Two => {
            Problem::<4, 2, _>::new(setup, &config, &knots, Free::<2, 4>::new(setup, &config))
                .solve()
        }
    };
    accepted(solved?, &knots)
}

/// The result, if it is worth more than the tracker's and agrees with it, at most epochs.
fn accepted(solved: Solved, knots: &Knots) -> Result<Smoothed, Unsmoothed> {
    let (mut certain, mut moved) = (Vec::new(), Vec::new());
    for (knot, epoch) in knots.points.iter().zip(&solved.epochs) {
        let (Some(before), Some(now)) = (knot.epoch.position, epoch.position) else { continue };
        let (Some(was), Some(is)) = (knot.epoch.sigma_m(), epoch.sigma_m()) else { continue };
        certain.push(is / was);
        moved.push((now[0] - before[0]).hypot(now[1] - before[1]) / was);
    }
    let median = |mut shares: Vec<f64>| {
        shares.sort_by(f64::total_cmp);
        shares.get(shares.len() / 2).copied()
    };
    if !median(certain).is_some_and(|share| share <= 1.0) {
        return Err(Unsmoothed::LessCertain);
    }
    if !rms(&moved).is_finite() || rms(&moved) > MOST_SIGMAS {
        return Err(Unsmoothed::Contradicts);
    }
    let mut parts: Vec<Vec<Epoch>> = vec![Vec::new(); knots.parts];
    for (knot, mut epoch) in knots.points.iter().zip(solved.epochs) {
        if epoch.is_vague() {
            epoch.health = Reason::NotObservable.state();
        } else if knot.epoch.is_vague() || knot.epoch.position.is_none() {
            epoch.health = State::Good;
        }
        parts[knot.part].push(epoch);
    }
    Ok(Smoothed { parts, biases: solved.biases, common: solved.common })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::{FoundHeight, RangeRow, Sensors, Wheels, track};
    use super::*;

    const ANCHORS: [[f64; 3]; 5] =
        [[0.0, 0.0, 2.0], [8.0, 0.0, 1.0], [8.0, 6.0, 2.0], [0.0, 6.0, 1.0], [4.0, -1.0, 1.5]];
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
        // What all have in common may be said of each.
        let mean = smoothed.biases.iter().map(|[bias, _]| bias).sum::<f64>() / 5.0;
        for ([bias, _], expected) in smoothed.biases.iter().zip(ERRORS) {
            assert!((bias - mean - expected + 0.01).abs() < 0.04, "{:?}", smoothed.biases);
        }
    }

    /// A driver that stamps the ranges of a round one after the other, some microseconds apart.
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
                health: State::Good,
            };
            MOST_KNOTS + 1
        ];
        let ends: Vec<_> = (0..many.len()).map(|k| Event::EpochEnd { time_us: k as i64 }).collect();
        let trace = Trace { epochs: many, ..Trace::default() };
        let parts = [Tracked { events: &ends, trace: &trace }];
        assert_eq!(smooth(&setup, &parts, false), Err(Unsmoothed::TooLong));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        /// Anchors on top of each other, ranges of anything, at times of anything: what comes out is a number, or a refusal.
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
}
