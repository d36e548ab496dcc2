//! Monitor of the errors of one satellite's phase.

use crate::Motion;
use crate::line::Line;
use kestirim_robust_kalman::{Decision, Reason};

/// Over how many epochs the noise is averaged.
const MEMORY: f64 = 30.0;
/// By how much a clock may be worse or better than it should be, or a moving receiver's phase worse, in
/// variances.
const LARGEST: f64 = 9.0;
/// Largest square of a single phase for the noise, in variances: outliers are not noise.
const LARGEST_SQUARE: f64 = 9.0;
/// Below this weight a phase counts as rejected.
const LEAST_WEIGHT: f64 = 0.1;
/// A slip jumps from one epoch to the next, by more than so many standard deviations of a
/// difference; what grows slowly is a clock or a multipath.
const JUMP: f64 = 3.5;
/// An ambiguity whose phase contradicts for so many times the patience without a jump begins anew, too.
const ENDURANCE: u8 = 10;

/// Errors of one satellite's phase from epoch to epoch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct PhaseMonitor {
    /// Variance of its modelled value: of a receiver at rest that of its interpolated clock alone,
    /// as a caesium clock wanders ten times as far as a rubidium clock; of one that moves, all of it.
    noise: f64,
    /// Residual when it was last used, m.
    residual: f64,
    /// Number of epochs, up to the last one, in which it was rejected.
    rejected: u8,
    /// Whether that began with a jump.
    jumped: bool,
    /// Whether it was not observed in the last epoch.
    absent: bool,
}

impl PhaseMonitor {
    pub(crate) const NEW: Self =
        Self { noise: 1.0, residual: 0.0, rejected: 0, jumped: false, absent: false };

    /// Factor of the variance.
    pub(crate) fn noise(&self) -> f64 {
        self.noise
    }

    /// Whether the ambiguity must be another one: the phase jumped and stays where it is for
    /// `patience` epochs.
    pub(crate) fn contradicts(&self, patience: u8) -> bool {
        let patience = if self.jumped { patience } else { patience.saturating_mul(ENDURANCE) };
        self.rejected > 0 && self.rejected >= patience
    }

    /// Whether the phase was rejected in the last epoch.
    pub(crate) fn is_rejected(&self) -> bool {
        self.rejected > 0
    }

    /// Residual of the last epoch, m, if it was observed in it and not rejected.
    pub(crate) fn residual(&self) -> Option<f64> {
        (self.rejected == 0 && !self.absent).then_some(self.residual)
    }

    /// An epoch has come; until an update tells, it is one without this phase.
    pub(crate) fn miss(&mut self) {
        self.absent = true;
    }

    /// The ambiguity begins anew.
    pub(crate) fn begin(&mut self) {
        *self = Self { noise: self.noise, ..Self::NEW };
    }

    /// Takes in the decision about the phase of an epoch, where the squares of all residuals are `common`
    /// times too large.
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

/// Whether a phase was judged by the others.
pub(crate) fn is_judged(phase: &Decision<f64>) -> bool {
    !matches!(phase.reason, Reason::NoRedundancy | Reason::TooFew)
}
