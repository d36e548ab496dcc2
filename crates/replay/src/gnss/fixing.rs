//! Fixing of ambiguities to integers alongside a filter, and its outcome.

use kestirim_gnss_ppp::{Geodetic, GpsTime};
use kestirim_ppp_filter::{
    AmbiguityFixer, FixedSolution, Health, PppFilter, SatelliteObservation, Solution,
};

use super::recording::Recording;

/// The standard deviation below which a position has converged, m, as in the filter.
const CONVERGED: f64 = 0.1;

/// The outcome of fixing ambiguities to integers.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Fixing {
    /// The number of epochs with fixed ambiguities.
    pub epochs: usize,
    /// The first time with fixed ambiguities, s since the midnight before the first epoch.
    pub first_s: Option<f64>,
    /// The number of ambiguities between satellites that were fixed in the last of these epochs.
    pub fixed: usize,
    /// The ratio test of the integers found last: the squared distance of the second nearest divided by that of the
    /// nearest.
    pub ratio: f64,
    /// The probability that the last integers found were right.
    pub success_rate: f64,
}

/// Fixes ambiguities to integers where that passes the tests. The filter keeps its own.
pub(super) struct Fixer<'a, const N: usize> {
    recording: &'a Recording,
    ambiguities: AmbiguityFixer<N>,
    fixing: Fixing,
}

impl<'a, const N: usize> Fixer<'a, N> {
    pub(super) fn new(recording: &'a Recording) -> Self {
        Self { recording, ambiguities: AmbiguityFixer::new(), fixing: Fixing::default() }
    }

    /// Replaces the filter's position by the one with fixed ambiguities, if they are known.
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
        // Backwards, the earliest time comes last.
        let first_s = Some(first_s.map_or(seconds, |first| first.min(seconds)));
        self.fixing = Fixing { epochs: epochs + 1, first_s, fixed, ratio, success_rate };
    }

    pub(super) fn finish(self) -> Fixing {
        self.fixing
    }
}
