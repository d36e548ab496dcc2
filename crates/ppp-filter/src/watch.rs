//! What a filter knows of the errors of one satellite's phase.

use crate::Motion;
use crate::line::Line;
use kestirim_robust_kalman::{Decision, Reason};

/// Over how many epochs the noise is averaged.
const MEMORY: f64 = 30.0;
/// By how much a clock may be worse or better than it should be, or a moving receiver's phase worse, in
/// variances.
const LARGEST: f64 = 9.0;
/// What a single phase may say about the noise at most, in variances: outliers are not noise.
const LOUDEST: f64 = 9.0;
/// Below this weight a phase has no say.
const UNHEARD: f64 = 0.1;
/// A slip jumps from one epoch to the next, by more than so many standard deviations of a
/// difference; what grows slowly is a clock or a multipath.
const JUMP: f64 = 3.5;
/// What contradicts for so many times the patience without having jumped is given up, too.
const ENDURANCE: u8 = 10;

/// The phase of one satellite from epoch to epoch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Watch {
    /// Its variance in what it should be: of a receiver at rest that of its interpolated clock alone,
    /// as a caesium clock wanders ten times as far as a rubidium clock; of one that moves, all of it.
    noise: f64,
    /// Its residual when it last had a say, m.
    residual: f64,
    /// In how many epochs, up to the last one, it had none.
    unheard: u8,
    /// Whether that began with a jump.
    jumped: bool,
}

impl Watch {
    pub(crate) const NEW: Self = Self { noise: 1.0, residual: 0.0, unheard: 0, jumped: false };

    /// By what a variance is multiplied.
    pub(crate) fn noise(&self) -> f64 {
        self.noise
    }

    /// Whether the ambiguity must be another one: the phase jumped and stays where it is for
    /// `patience` epochs.
    pub(crate) fn contradicts(&self, patience: u8) -> bool {
        let patience = if self.jumped { patience } else { patience.saturating_mul(ENDURANCE) };
        self.unheard > 0 && self.unheard >= patience
    }

    /// Whether the phase had no say in the last epoch.
    pub(crate) fn is_unheard(&self) -> bool {
        self.unheard > 0
    }

    /// The ambiguity begins anew.
    pub(crate) fn begin(&mut self) {
        *self = Self { noise: self.noise, ..Self::NEW };
    }

    /// Remembers what became of the phase of an epoch, where the squares of all residuals are `common`
    /// times too large.
    pub(crate) fn listen(
        &mut self,
        phase: &Decision<f64>,
        line: &Line,
        common: f64,
        motion: Motion,
    ) {
        let (own, clock) = (line.phase_variance * line.phase_noise, line.clock_variance);
        if phase.weight > UNHEARD {
            (self.unheard, self.jumped, self.residual) = (0, false, phase.residual);
        } else {
            if self.unheard == 0 {
                let jump = phase.residual - self.residual;
                let allowed = own + clock.min(2.0 * own);
                self.jumped = jump * jump > JUMP * JUMP * 2.0 * allowed;
            }
            self.unheard = self.unheard.saturating_add(1);
        }
        if is_judged(phase) {
            let square = (phase.standardised * phase.standardised / common).min(LOUDEST);
            let (share, least) = match motion {
                Motion::Static => (clock / (own + clock), 1.0 / LARGEST),
                Motion::Kinematic { .. } => (1.0, 1.0),
            };
            self.noise *= 1.0 + share * (square - 1.0) / MEMORY;
            self.noise = self.noise.clamp(least, LARGEST);
        }
    }
}

/// Whether the others said anything about a phase.
pub(crate) fn is_judged(phase: &Decision<f64>) -> bool {
    !matches!(phase.reason, Reason::NoRedundancy | Reason::TooFew)
}
