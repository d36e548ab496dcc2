//! Monitoring of the phase errors of one satellite.

use crate::Motion;
use crate::line::Line;
use kestirim_robust_kalman::{Decision, Reason};

/// The number of epochs over which the noise is averaged.
const MEMORY: f64 = 30.0;
/// The limit of the factor by which a clock may be worse or better than expected, or a moving receiver's phase worse,
/// in variances.
const LARGEST: f64 = 9.0;
/// The largest squared residual of a single phase that counts for the noise, in variances: outliers are not noise.
const LARGEST_SQUARE: f64 = 9.0;
/// A phase of at most this weight counts as rejected.
const LEAST_WEIGHT: f64 = 0.1;
/// A slip jumps from one epoch to the next by more than this many standard deviations of a difference; what grows
/// slowly is a clock error or multipath.
const JUMP: f64 = 3.5;
/// An ambiguity is also reset without a jump if its phase contradicts for this many times the patience.
const ENDURANCE: u8 = 10;

/// The phase errors of one satellite from epoch to epoch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct PhaseMonitor {
    /// The variance relative to its modelled value: for a receiver at rest only that of the interpolated clock, as a
    /// caesium clock wanders ten times as far as a rubidium clock; for a moving one the whole variance.
    noise: f64,
    /// The residual when the phase was last used, m.
    residual: f64,
    /// The number of consecutive epochs, up to the last one, in which the phase was rejected.
    rejected: u8,
    /// Whether the rejections began with a jump.
    jumped: bool,
    /// Whether the phase was not observed in the last epoch.
    absent: bool,
}

impl PhaseMonitor {
    pub(crate) const NEW: Self =
        Self { noise: 1.0, residual: 0.0, rejected: 0, jumped: false, absent: false };

    /// The factor on the variance.
    pub(crate) fn noise(&self) -> f64 {
        self.noise
    }

    /// Whether the ambiguity must have changed: the phase jumped and has stayed away for `patience` epochs, or
    /// contradicts for longer without a jump.
    pub(crate) fn contradicts(&self, patience: u8) -> bool {
        let patience = if self.jumped { patience } else { patience.saturating_mul(ENDURANCE) };
        self.rejected > 0 && self.rejected >= patience
    }

    /// Whether the phase was rejected in the last epoch.
    pub(crate) fn is_rejected(&self) -> bool {
        self.rejected > 0
    }

    /// The residual of the last epoch, m, if the phase was observed in it and not rejected.
    pub(crate) fn residual(&self) -> Option<f64> {
        (self.rejected == 0 && !self.absent).then_some(self.residual)
    }

    /// Marks the phase as absent from the new epoch, until it is updated.
    pub(crate) fn miss(&mut self) {
        self.absent = true;
    }

    /// Resets the monitor for a new ambiguity.
    pub(crate) fn begin(&mut self) {
        *self = Self { noise: self.noise, ..Self::NEW };
    }

    /// Updates the monitor with the decision about the phase in an epoch in which the squares of all residuals are
    /// `common` times too large.
    pub(crate) fn update(
        &mut self,
        phase: &Decision<f64>,
        line: &Line,
        common: f64,
        motion: Motion,
    ) {
        self.absent = false;
        let (own, clock) = (line.phase_variance * line.phase_noise, line.clock_variance);
        if phase.weight > LEAST_WEIGHT {
            (self.rejected, self.jumped, self.residual) = (0, false, phase.residual);
        } else {
            if self.rejected == 0 {
                let jump = phase.residual - self.residual;
                let allowed = own + clock.min(2.0 * own);
                self.jumped = jump * jump > JUMP * JUMP * 2.0 * allowed;
            }
            self.rejected = self.rejected.saturating_add(1);
        }
        if is_judged(phase) {
            let square = (phase.standardised * phase.standardised / common).min(LARGEST_SQUARE);
            let (share, least) = match motion {
                Motion::Static => (clock / (own + clock), 1.0 / LARGEST),
                Motion::Kinematic { .. } => (1.0, 1.0),
            };
            self.noise *= 1.0 + share * (square - 1.0) / MEMORY;
            self.noise = self.noise.clamp(least, LARGEST);
        }
    }
}

/// Whether a phase was judged against the other observations.
pub(crate) fn is_judged(phase: &Decision<f64>) -> bool {
    !matches!(phase.reason, Reason::NoRedundancy | Reason::TooFew)
}
