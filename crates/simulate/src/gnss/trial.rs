//! One trial of filters on a station-day, with faults and without.

use kestirim_gnss_ppp::{Corrections, Receiver};
use kestirim_ppp_filter::{Config, PppFilter, SatelliteObservation, states};
use kestirim_replay::gnss::{Accuracy, Fix};
use nalgebra::Vector3;
use rayon::prelude::*;

use super::{Day, MIDNIGHT, Rates, UTC_MINUS_GPS};

/// The number of states of a filter with room for 16 satellites.
const STATES: usize = states(16);

/// The errors of a filter on a station-day.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Score {
    /// The absolute error of the last solution: north, east, up and in three dimensions, mm.
    pub final_mm: [f64; 4],
    /// The root mean square of the errors after the first hour: north, east, up and in three dimensions, mm.
    pub rms_mm: [f64; 4],
    /// The time from the first epoch until the error stays below 10 cm for 15 minutes, min.
    pub convergence_min: Option<f64>,
    /// The number of epochs without a solution.
    pub unsolved: usize,
}

impl Score {
    /// The names of the [`numbers`](Self::numbers).
    pub const COLUMNS: [&'static str; 10] = [
        "final north_mm",
        "final east_mm",
        "final up_mm",
        "final 3d_mm",
        "rms north_mm",
        "rms east_mm",
        "rms up_mm",
        "rms 3d_mm",
        "convergence_min",
        "unsolved",
    ];

    /// The score as a row of numbers; NaN for a convergence that never came.
    pub fn numbers(&self) -> [f64; Self::COLUMNS.len()] {
        let [a, b, c, d] = self.final_mm;
        let [e, f, g, h] = self.rms_mm;
        let converged = self.convergence_min.unwrap_or(f64::NAN);
        [a, b, c, d, e, f, g, h, converged, self.unsolved as f64]
    }

    /// The score that the first numbers of a row stand for.
    pub fn of_numbers(row: &[f64]) -> Self {
        let four = |first: usize| std::array::from_fn(|part| row[first + part]);
        Self {
            final_mm: four(0),
            rms_mm: four(4),
            convergence_min: Some(row[8]).filter(|minutes| !minutes.is_nan()),
            unsolved: row[9] as usize,
        }
    }

    /// The score of a day of `epochs` epochs that begins at midnight.
    fn of(fixes: &[Fix], epochs: usize, truth: &Vector3<f64>) -> Self {
        let unsolved = epochs - fixes.len();
        let Some(accuracy) = Accuracy::of(fixes, 0.0, truth) else {
            return Self { final_mm: [f64::NAN; 4], unsolved, ..Self::default() };
        };
        let mm = |[east, north, up]: [f64; 3], all: f64| {
            [north, east, up, all].map(|metres: f64| 1e3 * metres.abs())
        };
        let (rms_enu, rms_3d) = (accuracy.rms_enu_m, accuracy.rms_3d_m);
        Self {
            final_mm: mm(accuracy.final_enu_m, accuracy.final_3d_m),
            rms_mm: mm(rms_enu.unwrap_or_default(), rms_3d.unwrap_or_default()),
            convergence_min: accuracy.convergence_min,
            unsolved,
        }
    }
}

/// The score of each filter on one station-day; those with `true` see the day's faults, the others the same day without.
pub fn trial(seed: u64, index: u64, filters: &[(Config, bool)]) -> Vec<Score> {
    let days = [Rates::NONE, Rates::RECORDING].map(|rates| Day::new(seed, index, &rates));
    let observations = days.each_ref().map(observations);
    // The filters of a day run in parallel, so that even a few days keep all threads busy.
    filters
        .par_iter()
        .map(|(config, faults)| {
            let which = usize::from(*faults);
            follow(&days[which], &observations[which], config)
        })
        .collect()
}

/// The observations of the receiver, with the products of each satellite.
fn observations(day: &Day) -> Vec<Vec<SatelliteObservation<'_>>> {
    let epochs = day.epochs.iter().map(|epoch| {
        let seen = epoch.satellites.iter();
        seen.filter_map(|observed| day.products.observation(epoch.time, observed).ok()).collect()
    });
    epochs.collect()
}

/// Runs one filter through one day.
fn follow(day: &Day, observations: &[Vec<SatelliteObservation<'_>>], config: &Config) -> Score {
    let receiver = Receiver {
        antenna: None,
        galileo_antenna: None,
        glonass_antenna: None,
        beidou_antenna: None,
        eccentricity: [0.0; 3],
        ocean_loading: None,
        pole: None,
        ut1_minus_gps: UTC_MINUS_GPS,
        corrections: Corrections::ALL,
    };
    let mut filter = PppFilter::<STATES>::new(*config);
    let fixes = day.epochs.iter().zip(observations).filter_map(|(epoch, observations)| {
        let solution = filter.process(epoch.time, &receiver, observations).ok()?;
        Some(Fix { t: epoch.time.since(MIDNIGHT), position: solution.position })
    });
    Score::of(&fixes.collect::<Vec<_>>(), day.epochs.len(), &day.marker)
}

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_ppp_filter::{Estimator, Motion};

    /// The scores (plain, default) on one day without faults, and with them.
    fn plain_and_default(index: u64) -> [[Score; 2]; 2] {
        [Rates::NONE, Rates::RECORDING].map(|rates| {
            let day = Day::new(11, index, &rates);
            let observations = observations(&day);
            [Estimator::plain(), Estimator::guarded(Motion::Static)].map(|estimator| {
                let config = Config { estimator, gradient: 0.0, ..Config::new(Motion::Static) };
                follow(&day, &observations, &config)
            })
        })
    }

    #[test]
    fn faults_harm_the_plain_filter_and_not_the_default() {
        for index in 0..3 {
            let [clean, faulty] = plain_and_default(index);
            for score in clean {
                assert!(score.final_mm[3] < 15.0 && score.rms_mm[3] < 30.0, "{score:?}");
                assert!(score.convergence_min.is_some_and(|minutes| minutes < 90.0), "{score:?}");
                assert_eq!(score.unsolved, 0);
            }
            let [plain, default] = faulty.map(|score| score.rms_mm[3]);
            assert!(plain > 70.0 && default < plain / 3.0, "{index}: {plain} {default}");
            assert!(default < 35.0, "{index}: {default}");
        }
    }
}
