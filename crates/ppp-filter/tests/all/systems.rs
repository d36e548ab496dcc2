//! Tests of the filter with satellites of several systems, each with a clock of its own.

use crate::filter::{SLOW, error, filter, run};
use crate::sky::{START, marker};
use kestirim_gnss_ppp::{Carriers, Constellation, Receiver, Site};
use kestirim_ppp_filter::{Config, Motion, PppFilter, SatelliteObservation, Slipped, states};
use nalgebra::Vector3;

/// Half of the satellites are of Galileo, whose clocks the receiver sees with an offset of 30 m.
#[test]
fn galileo_beside_gps() {
    let as_galileo = |observations: &mut Vec<SatelliteObservation<'static>>, all: bool| {
        for observation in observations.iter_mut().filter(|it| all || it.satellite % 2 == 0) {
            observation.satellite += 100;
            observation.carriers = Carriers::E1E5a;
            for carrier in 0..2 {
                let [before, after] = [Carriers::L1L2, Carriers::E1E5a].map(Carriers::wavelength);
                observation.phase[carrier] *= before[carrier] / after[carrier];
                observation.phase[carrier] += 30.0 / after[carrier];
                observation.code[carrier] += 30.0;
            }
        }
    };
    for motion in [Motion::Static, SLOW] {
        let both =
            run(&mut filter(motion), 3600.0, |_, observations| as_galileo(observations, false));
        assert!(error(both.last().unwrap()) < 3e-3, "{}", error(both.last().unwrap()));
        let lost = |seconds: f64, observations: &mut Vec<_>| {
            as_galileo(observations, false);
            if seconds > 1800.0 {
                observations.retain(|it: &SatelliteObservation<'_>| it.satellite > 100);
            }
        };
        let few = run(&mut filter(motion), 1830.0, lost);
        assert!(error(few.last().unwrap()) < 2e-2, "{}", error(few.last().unwrap()));
        let alone =
            run(&mut filter(motion), 3600.0, |_, observations| as_galileo(observations, true));
        assert!(error(alone.last().unwrap()) < 5e-3, "{}", error(alone.last().unwrap()));
    }
}

/// A receiver that goes over to another carrier begins the satellite's ambiguity anew, once.
#[test]
fn other_carriers_are_one_interruption() {
    let other = |seconds: f64, observations: &mut Vec<SatelliteObservation<'static>>| {
        for observation in observations.iter_mut().filter(|it| it.satellite % 3 == 0) {
            let before = observation.carriers.wavelength();
            observation.carriers = if seconds < 1800.0 { Carriers::E1E5a } else { Carriers::E1E5b };
            let after = observation.carriers.wavelength();
            for carrier in 0..2 {
                observation.phase[carrier] *= before[carrier] / after[carrier];
            }
        }
    };
    let solutions = run(&mut filter(Motion::Static), 3600.0, other);
    for pair in solutions.windows(2) {
        let was_seen = |number| pair[0].satellites.iter().any(|it| it.satellite == number);
        let [before, now] = [pair[0].time, pair[1].time].map(|time| time.since(START));
        let goes_over = before < 1800.0 && now >= 1800.0;
        for report in pair[1].satellites.iter().filter(|it| was_seen(it.satellite)) {
            let begins = goes_over && report.satellite % 3 == 0;
            assert_eq!(report.slipped, begins.then_some(Slipped::New), "{now} s: {report:?}");
        }
    }
    assert!(error(solutions.last().unwrap()) < 5e-3, "{}", error(solutions.last().unwrap()));
}

/// Changes the observations as if a third of the satellites were of GLONASS and a third of BeiDou, with clock offsets,
/// and with codes that are off by metres for each satellite of these systems.
fn of_three_systems(observations: &mut [SatelliteObservation<'static>]) {
    for observation in observations {
        let number = observation.satellite;
        let (carriers, clock, off) = match number % 3 {
            0 => continue,
            1 => (Carriers::G1G2 { channel: number.cast_signed() % 14 - 7 }, -70.0, 1.0),
            _ => (Carriers::B1B3, 110.0, -1.0),
        };
        observation.carriers = carriers;
        let [before, after] = [Carriers::L1L2, carriers].map(Carriers::wavelength);
        for carrier in 0..2 {
            observation.phase[carrier] *= before[carrier] / after[carrier];
            observation.phase[carrier] += clock / after[carrier];
            observation.code[carrier] += clock + off * (f64::from(number % 5) - 2.0);
        }
    }
}

#[test]
fn three_systems_have_clocks_of_their_own() {
    for motion in [Motion::Static, SLOW] {
        let all = run(&mut filter(motion), 3600.0, |_, seen| of_three_systems(seen));
        let last = all.last().unwrap();
        assert!(error(last) < 2e-2, "{}", error(last));
        // Without GPS from some time on, or from the beginning.
        for from in [1800.0, -1.0] {
            let lost = |seconds: f64, observations: &mut Vec<_>| {
                of_three_systems(observations);
                observations.retain(|it: &SatelliteObservation<'_>| {
                    seconds < from || it.carriers.constellation() != Constellation::Gps
                });
            };
            let few = run(&mut filter(motion), 3600.0, lost);
            // Five satellites on two clocks do not improve it.
            let last = few.last().unwrap();
            let deviation = Vector3::from(last.deviations_enu()).norm();
            assert!(error(last) < 2.0 * deviation, "{from}: {} {deviation}", error(last));
        }
    }
}

/// A filter that GPS fills except for one state has no room for the first satellite of another system; once it has,
/// that satellite is used like any other.
#[test]
fn a_system_without_room_begins_when_there_is_some() {
    const SEEN: usize = 9;
    let config = Config { gradient: 0.0, ..Config::new(Motion::Static) };
    let mut full = PppFilter::<{ states(SEEN) }>::new(config);
    // The last satellite is of GLONASS, and the first one disappears after a while.
    let solutions = run(&mut full, 1800.0, |seconds, observations| {
        let is_high = |it: &SatelliteObservation<'_>| {
            let site = Site::new(&Receiver::default(), &marker(), START.plus(seconds));
            let expected = site.expect(&it.state, it.carriers, None, None);
            expected.is_some_and(|it| it.direction.elevation > config.elevation_mask)
        };
        observations.retain(is_high);
        observations.truncate(SEEN);
        if seconds > 600.0 {
            observations.remove(0);
        }
        let last = observations.last_mut().expect("a satellite");
        let before = last.carriers.wavelength();
        last.carriers = Carriers::G1G2 { channel: 2 };
        for carrier in 0..2 {
            let after = last.carriers.wavelength()[carrier];
            last.phase[carrier] = (last.phase[carrier] * before[carrier] - 70.0) / after;
            last.code[carrier] -= 70.0;
        }
    });
    let used = |at: usize| solutions[at].satellites.len();
    assert_eq!((used(0), used(solutions.len() - 1)), (SEEN - 1, SEEN - 1));
    for solution in &solutions {
        let deviation = Vector3::from(solution.deviations_enu()).norm();
        assert!(error(solution) < 2.0 * deviation, "{} {deviation}", error(solution));
        assert!(solution.satellites.iter().all(|it| it.code.weight > 0.0 && it.phase.weight > 0.0));
    }
}
