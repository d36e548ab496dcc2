//! Tests of the filter under a sky without noise: what it must find, and what must not deceive it.

use crate::sky::{START, marker, observe, spoil};
use core::slice;
use kestirim_gnss_ppp::{FREQUENCY, Receiver, Site, Slip, gradient_mapping};
use kestirim_ppp_filter::{
    Config, Deviation, Error, Estimator, Health, Motion, PppFilter, SatelliteObservation,
    SatelliteReport, Slipped, Solution, states,
};
use nalgebra::Vector3;
use proptest::prelude::*;

const N: usize = states(20);
pub(crate) const SLOW: Motion = Motion::Kinematic { process_noise: 1e-4 };

pub(crate) fn filter(motion: Motion) -> PppFilter<N> {
    PppFilter::new(Config::new(motion))
}

fn step<const N: usize>(
    filter: &mut PppFilter<N>,
    seconds: f64,
    observations: &[SatelliteObservation<'_>],
) -> Result<Solution<N>, Error> {
    filter.process(START.plus(seconds), &Receiver::default(), observations)
}

/// Runs epochs every half minute up to `until`, as `change` alters them.
pub(crate) fn run<const N: usize>(
    filter: &mut PppFilter<N>,
    until: f64,
    change: impl Fn(f64, &mut Vec<SatelliteObservation<'static>>),
) -> Vec<Solution<N>> {
    let epochs = (0..).map(|k| 30.0 * f64::from(k)).take_while(|&seconds| seconds <= until);
    epochs
        .map(|seconds| {
            let mut observations = observe(seconds, &marker());
            change(seconds, &mut observations);
            step(filter, seconds, &observations).expect("a solution")
        })
        .collect()
}

/// A satellite that stays in view.
fn highest() -> u8 {
    let solution = step(&mut filter(Motion::Static), 1800.0, &observe(1800.0, &marker())).unwrap();
    let elevation = |a: &SatelliteReport| a.direction.elevation;
    let by_elevation = |a: &&_, b: &&_| elevation(a).total_cmp(&elevation(b));
    solution.satellites.iter().max_by(by_elevation).unwrap().satellite
}

pub(crate) fn error<const N: usize>(solution: &Solution<N>) -> f64 {
    (solution.position - marker()).norm()
}

#[test]
fn a_clean_sky_is_fixed_to_millimetres() {
    for motion in [Motion::Static, SLOW] {
        let solutions = run(&mut filter(motion), 3600.0, |_, _| {});
        let last = solutions.last().unwrap();
        assert!(last.satellites.len() >= 6, "{}", last.satellites.len());
        assert!(error(last) < 2e-3, "{motion:?}: {}", error(last));
        let untreated = |solution: &Solution<N>| {
            solution.satellites.iter().all(|it| !it.code.was_treated() && !it.phase.was_treated())
        };
        assert!(solutions.iter().all(untreated));
        let ([east, north, up], trace) = (last.deviations_enu(), last.covariance.trace());
        assert!((east * east + north * north + up * up - trace).abs() < 1e-9 * trace);
    }
}

/// Processed backwards, the first epoch is known as well as the whole run determines it, and slips are detected, too.
#[test]
fn a_run_is_gone_through_from_its_end() {
    let victim = highest();
    let mut filter = filter(Motion::Static);
    let back = |filter: &mut PppFilter<N>, seconds: f64| {
        let mut observations = observe(seconds, &marker());
        // A slip after 1800 s, seen before it in this direction, and the gap of a satellite.
        for observation in observations.iter_mut().filter(|it| it.satellite == victim) {
            observation.phase[0] += if seconds > 1800.0 { 100.0 } else { 0.0 };
        }
        observations.retain(|it| it.satellite == victim || !(900.0..1500.0).contains(&seconds));
        filter.process_backwards(START.plus(seconds), &Receiver::default(), &observations)
    };
    let mut last = None;
    for k in (0..=120).rev() {
        let seconds = 30.0 * f64::from(k);
        match back(&mut filter, seconds) {
            Ok(solution) => {
                let report = solution.satellites.iter().find(|it| it.satellite == victim);
                let slipped = report.and_then(|report| report.slipped);
                let expected = match k {
                    120 => Some(Slipped::New),
                    60 => Some(Slipped::Seen(Slip::GeometryFree)),
                    29 => Some(Slipped::Seen(Slip::Gap)),
                    _ => None,
                };
                assert_eq!(slipped, expected, "{k}");
                last = Some(solution);
            }
            Err(error) => assert!((30..50).contains(&k) && error == Error::TooFewSatellites),
        }
    }
    let last = last.expect("a solution");
    assert!(error(&last) < 2e-3, "{}", error(&last));
    for seconds in [0.0, 30.0, f64::NAN] {
        assert_eq!(back(&mut filter, seconds).unwrap_err(), Error::TimeNotAdvancing);
    }
}

#[test]
fn a_slip_that_no_detector_sees_is_found_by_the_filter() {
    let victim = highest();
    let slip = |seconds: f64, observations: &mut Vec<SatelliteObservation<'static>>| {
        if seconds >= 1800.0 {
            spoil(observations, victim, 0.0, 0.3);
        }
    };
    let ours = run(&mut filter(Motion::Static), 3600.0, slip);
    let slipped = |solution: &Solution<N>| {
        let found = solution.satellites.iter().find(|it| it.satellite == victim);
        found.and_then(|it| it.slipped)
    };
    let when: Vec<usize> =
        (60..ours.len()).filter(|&epoch| slipped(&ours[epoch]).is_some()).collect();
    assert_eq!(when, [63], "after three epochs without a say");
    assert_eq!(slipped(&ours[63]), Some(Slipped::Contradicted));
    assert!(error(ours.last().unwrap()) < 5e-3);

    let config = Config { estimator: Estimator::plain(), ..Config::new(Motion::Static) };
    let plain = run(&mut PppFilter::<N>::new(config), 3600.0, slip);
    assert!(error(plain.last().unwrap()) > 2e-2);
}

#[test]
fn an_outlier_is_left_out_and_told() {
    let victim = highest();
    let solutions = run(&mut filter(Motion::Static), 1860.0, |seconds, observations| {
        if seconds == 1800.0 {
            spoil(observations, victim, 20.0, -0.5);
        }
    });
    let report = |epoch: usize| {
        *solutions[epoch].satellites.iter().find(|it| it.satellite == victim).unwrap()
    };
    let hit = report(60);
    assert!(hit.code.weight == 0.0 && hit.phase.weight == 0.0);
    assert!((hit.code.residual - 20.0).abs() < 0.1 && (hit.phase.residual + 0.5).abs() < 0.02);
    assert!(!report(61).phase.was_treated() && report(62).slipped.is_none());
    assert!(error(&solutions[60]) < 5e-3);
}

/// A step of a metre that all satellites show is no outlier.
#[test]
fn a_step_is_motion() {
    let step = Vector3::new(0.6, -0.6, 0.53);
    let solutions = run(&mut filter(SLOW), 2400.0, |seconds, observations| {
        if seconds >= 1800.0 {
            *observations = observe(seconds, &(marker() + step));
        }
    });
    for solution in &solutions[60..] {
        let missed = (solution.position - marker() - step).norm();
        assert!(missed < 0.03, "{missed}");
        assert!(solution.satellites.iter().all(|it| it.phase.weight > 0.9));
    }
}

/// A receiver on a fast train is found where it is, although the model is linearised.
#[test]
fn a_fast_receiver_is_followed() {
    let mut filter = filter(Motion::Kinematic { process_noise: 100.0 });
    for epoch in 0..60 {
        let seconds = 30.0 * f64::from(epoch);
        let place = marker() + Vector3::new(-20.0, 60.0, 8.0) * seconds;
        let solution = step(&mut filter, seconds, &observe(seconds, &place)).unwrap();
        let missed = (solution.position - place).norm();
        assert!(epoch < 30 || missed < 0.1, "{missed}");
    }
}

#[test]
fn an_epoch_without_a_solution_leaves_no_trace() {
    let mut disturbed = filter(Motion::Static);
    run(&mut disturbed, 600.0, |_, _| {});
    let mut undisturbed = disturbed;
    let observations = observe(630.0, &marker());
    assert_eq!(
        step(&mut disturbed, 630.0, &observations[..3]).unwrap_err(),
        Error::TooFewSatellites
    );
    assert_eq!(step(&mut disturbed, 600.0, &observations).unwrap_err(), Error::TimeNotAdvancing);
    assert_eq!(step(&mut disturbed, f64::NAN, &observations).unwrap_err(), Error::TimeNotAdvancing);
    let [a, b] =
        [&mut disturbed, &mut undisturbed].map(|it| step(it, 660.0, &observe(660.0, &marker())));
    assert_eq!(a.unwrap(), b.unwrap());
    let start = step(&mut filter(Motion::Static), 0.0, &observations[..3]);
    assert_eq!(start.unwrap_err(), Error::TooFewSatellites);
}

#[test]
fn what_is_no_observation_is_left_out() {
    let (mut spoilt, mut clean) = (filter(Motion::Static), filter(Motion::Static));
    for epoch in 0..20 {
        let seconds = 30.0 * f64::from(epoch);
        let mut observations = observe(seconds, &marker());
        let without = observations[1..].to_vec();
        observations[0].phase[1] = f64::NAN;
        // The same satellite twice.
        observations.push(SatelliteObservation { code: [2e7; 2], ..observations[2] });
        let solutions =
            [step(&mut spoilt, seconds, &observations), step(&mut clean, seconds, &without)];
        let [spoilt, clean] = solutions.map(Result::unwrap);
        let heard = |solution: &Solution<N>| {
            solution.satellites.iter().map(|it| it.satellite).collect::<Vec<_>>()
        };
        assert_eq!(heard(&spoilt), heard(&clean));
        // The start uses the code without its phase.
        assert!((spoilt.position - clean.position).norm() < 0.02);
    }
}

#[test]
fn more_satellites_than_places() {
    let mut small = PppFilter::<{ states(5) }>::new(Config::new(Motion::Static));
    for epoch in 0..240 {
        let seconds = 60.0 * f64::from(epoch);
        let solution = step(&mut small, seconds, &observe(seconds, &marker())).unwrap();
        assert_eq!(solution.satellites.len(), 5);
    }
}

/// Ten minutes without an epoch do not improve the position.
#[test]
fn a_pause_is_no_knowledge() {
    let mut filter = filter(Motion::Static);
    let before = run(&mut filter, 1800.0, |_, _| {}).pop().unwrap().covariance.trace();
    let after = step(&mut filter, 2400.0, &observe(2400.0, &marker())).unwrap();
    assert!(after.covariance.trace() > 0.5 * before);
}

#[test]
fn settings_that_are_none_are_refused() {
    let right = Config::new(SLOW);
    let wrong = [
        Config { correlation_time: -1.0, ..right },
        Config { wet_delay: f64::NAN, ..right },
        Config { motion: Motion::Kinematic { process_noise: -1.0 }, ..right },
        Config { phase: Deviation { zenith: 0.0, slant: 0.0 }, ..right },
    ];
    for config in wrong {
        let outcome = step(&mut PppFilter::<N>::new(config), 0.0, &observe(0.0, &marker()));
        assert_eq!(outcome.unwrap_err(), Error::InvalidConfiguration);
    }
}

#[test]
fn a_satellite_that_was_away_begins_anew() {
    let mut filter = filter(Motion::Static);
    let away = |seconds: f64, observations: &mut Vec<SatelliteObservation<'static>>| {
        if (600.0..1200.0).contains(&seconds) {
            observations.remove(0);
        }
    };
    let solutions = run(&mut filter, 1500.0, away);
    let back = solutions[40].satellites[0].slipped;
    assert_eq!(back, Some(Slipped::Seen(kestirim_gnss_ppp::Slip::Gap)));
    assert!(error(solutions.last().unwrap()) < 2e-2);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// Whatever the input, the result is an error or finite numbers.
    #[test]
    fn nothing_panics(
        changes in prop::collection::vec((0..40_usize, 0..6_usize, any::<f64>(), any::<u8>()), 0..60),
        steps in prop::collection::vec(prop_oneof![8 => Just(30.0), 1 => 0.0..1e4, 1 => any::<f64>()], 12),
    ) {
        let mut filter = filter(SLOW);
        let mut seconds = 0.0;
        for (epoch, step_by) in steps.into_iter().enumerate() {
            let mut observations = observe(30.0 * epoch as f64, &marker());
            for &(place, which, value, satellite) in changes.iter().skip(epoch * 5).take(5) {
                let Some(observation) = observations.get_mut(place) else { continue };
                match which {
                    0 => observation.code[0] = value,
                    1 => observation.phase[1] = value,
                    2 => observation.satellite = satellite,
                    3 => observation.state.position.x = value,
                    4 => observation.state.velocity.y = value,
                    _ => observation.state.clock = value,
                }
            }
            if let Ok(solution) = step(&mut filter, seconds + step_by, &observations) {
                seconds += step_by;
                prop_assert!(solution.position.iter().all(|value| value.is_finite()));
                prop_assert!(solution.covariance.iter().all(|value| value.is_finite()));
            }
        }
    }
}

/// Receivers keep their clock near GPS time by whole milliseconds, and some apply the steps to the phases or codes
/// alone.
#[test]
fn a_millisecond_is_repaired_whatever_the_filter() {
    let milliseconds = |seconds: f64| f64::from(u8::from(seconds >= 1800.0)) * -2e-3;
    let estimators = [
        Estimator::plain(),
        Estimator::igg3(),
        Estimator::t_test(),
        Estimator::adaptive(),
        Estimator::guarded(Motion::Static),
    ];
    for estimator in estimators {
        let config = Config { estimator, ..Config::new(Motion::Static) };
        let solutions = run(&mut PppFilter::<N>::new(config), 2400.0, |seconds, observations| {
            for observation in observations {
                for (phase, frequency) in observation.phase.iter_mut().zip(FREQUENCY) {
                    *phase += milliseconds(seconds) * frequency;
                }
            }
        });
        let told = |solution: &&Solution<N>| solution.milliseconds != 0;
        assert_eq!(solutions.iter().filter(told).count(), 1);
        assert_eq!(solutions[60].milliseconds, -2);
        assert!(solutions.iter().skip(60).all(|it| error(it) < 5e-3), "{estimator:?}");
        let slipped = |it: &SatelliteReport| matches!(it.slipped, Some(Slipped::Seen(_)));
        assert!(!solutions.iter().any(|it| it.satellites.iter().any(slipped)));
    }
}

/// Half a millisecond is no known clock jump: all ambiguities are reset.
#[test]
fn any_other_jump_of_all_phases_is_a_slip_of_all() {
    let config = Config { estimator: Estimator::plain(), ..Config::new(Motion::Static) };
    let solutions = run(&mut PppFilter::<N>::new(config), 2400.0, |seconds, observations| {
        for observation in observations.iter_mut().filter(|_| seconds >= 1800.0) {
            for (phase, frequency) in observation.phase.iter_mut().zip(FREQUENCY) {
                *phase += 5e-4 * frequency;
            }
        }
    });
    let clock = Some(Slipped::Seen(Slip::Clock));
    assert!(solutions[60].satellites.iter().all(|it| it.slipped == clock));
    assert!(solutions.iter().skip(60).all(|it| error(it) < 5e-3));
}

/// A receiver configured to be at rest is carried off.
#[test]
fn who_moves_is_not_at_rest() {
    let away = Vector3::new(2.0, -2.0, 1.0);
    for estimator in [Estimator::plain(), Estimator::guarded(Motion::Static)] {
        let config = Config { estimator, ..Config::new(Motion::Static) };
        let mut filter = PppFilter::<N>::new(config);
        let before = run(&mut filter, 3600.0, |_, _| {});
        assert_eq!(before.last().unwrap().health, Health::Converged);
        let trusted = |epoch: u32| {
            let seconds = 3630.0 + 30.0 * f64::from(epoch);
            let observations = observe(seconds, &(marker() + away));
            let solution = step(&mut filter, seconds, &observations).unwrap();
            !matches!(solution.health, Health::Contradicted(_))
        };
        let longest = (0..200).map(trusted).collect::<Vec<_>>();
        assert!(longest[10..].iter().all(|trusted| !trusted), "{estimator:?} {longest:?}");
    }
}

/// A troposphere with gradients of 0.8 mm to the north and −0.6 mm to the east: 2.4 and 1.8 cm at 10° of elevation.
#[test]
fn gradients_are_found_where_they_can_be() {
    const GRADIENTS: [f64; 2] = [8e-4, -6e-4];
    fn slanted<const N: usize>(config: &Config, clock_interval: f64) -> Solution<N> {
        let slant = |seconds: f64, observations: &mut Vec<SatelliteObservation<'static>>| {
            let site = Site::new(&Receiver::default(), &marker(), START.plus(seconds));
            for observation in observations {
                let SatelliteObservation { satellite, carriers, ref mut state, .. } = *observation;
                let expected = site.expect(state, carriers, None, None).unwrap();
                let mapping = gradient_mapping(&expected.local);
                let delay: f64 = mapping.iter().zip(GRADIENTS).map(|(m, g)| m * g).sum();
                state.clock_interval = clock_interval;
                spoil(slice::from_mut(observation), satellite, delay, delay);
            }
        };
        run(&mut PppFilter::<N>::new(*config), 7200.0, slant).pop().unwrap()
    }
    let config = Config::new(Motion::Static);
    let found = slanted::<N>(&config, 30.0);
    let [north, east] = [0, 1].map(|axis| (found.gradients[axis] - GRADIENTS[axis]).abs());
    assert!(north < 5e-5 && east < 5e-5, "{:?}", found.gradients);
    assert!(error(&found) < 2e-3, "{}", error(&found));
    // Gradients are not estimated if not configured, with clocks known every quarter of an hour, or without room for
    // them.
    let without = Config { gradient: 0.0, ..config };
    for unseen in [slanted::<N>(&without, 30.0), slanted::<N>(&config, 900.0)] {
        assert_eq!(unseen.gradients, [0.0; 2]);
        assert!(error(&unseen) > 4.0 * error(&found), "{}", error(&unseen));
    }
    let small = slanted::<{ states(4) }>(&config, 30.0);
    assert_eq!((small.gradients, small.satellites.len()), ([0.0; 2], 4));
}
