//! Whole ambiguities beside a filter, and what came of them.

use kestirim_gnss_ppp::{Geodetic, GpsTime};
use kestirim_ppp_filter::{
    AmbiguityFixer, FixedSolution, Health, PppFilter, SatelliteObservation, Solution,
};

use super::recording::Recording;

/// Below this standard deviation a position is a converged one, m, as the filter has it.
const CONVERGED: f64 = 0.1;

/// What came of whole ambiguities.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Fixing {
    /// In how many epochs there were some.
    pub epochs: usize,
    /// When there were some for the first time, s since the midnight before the first epoch.
    pub first_s: Option<f64>,
    /// How many ambiguities between satellites were whole in the last of them, …
    pub fixed: usize,
    /// … and of the integers that were found last how much farther the second nearest were, in squares, …
    pub ratio: f64,
    /// … and how probable they were.
    pub success_rate: f64,
}

/// Makes ambiguities whole where that passes the tests. The filter keeps its own.
pub(super) struct Fixer<'a, const N: usize> {
    recording: &'a Recording,
    ambiguities: AmbiguityFixer<N>,
    fixing: Fixing,
}

impl<'a, const N: usize> Fixer<'a, N> {
    pub(super) fn new(recording: &'a Recording) -> Self {
        Self { recording, ambiguities: AmbiguityFixer::new(), fixing: Fixing::default() }
    }

    /// Puts the position with whole ambiguities in the place of the filter's, if they are known.
    pub(super) fn fix(
        &mut self,
        time: GpsTime,
        filter: &PppFilter<N>,
        observations: &[SatelliteObservation<'_>],
        solution: &mut Solution<N>,
    ) {
        if self.recording.never_whole().is_some() {
            return;
        }
        let whole = self.recording.products().whole();
        let bias = |satellite| whole.of(satellite, time);
        let Some(fixed) = self.ambiguities.fix(filter, solution, observations, bias) else {
            return;
        };
        let FixedSolution { position, covariance_enu, fixed, ratio, success_rate } = fixed;
        let rotation = Geodetic::from_ecef(&position).enu_from_ecef();
        solution.position = position;
        solution.covariance_enu = covariance_enu;
        solution.covariance = rotation.transpose() * covariance_enu * rotation;
        if solution.health == Health::Converging && covariance_enu.trace() < CONVERGED * CONVERGED {
            solution.health = Health::Converged;
        }
        let seconds = time.since(self.recording.midnight);
        let Fixing { epochs, first_s, .. } = self.fixing;
        // Backwards the first one comes last.
        let first_s = Some(first_s.map_or(seconds, |first| first.min(seconds)));
        self.fixing = Fixing { epochs: epochs + 1, first_s, fixed, ratio, success_rate };
    }

    pub(super) fn finish(self) -> Fixing {
        self.fixing
    }
}
