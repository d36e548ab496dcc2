//! What a filter knows of the errors of one satellite's phase.

use kestirim_robust_kalman::{Decision, Reason};

/// Over how many epochs the noise is averaged.
const MEMORY: f64 = 30.0;
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
    /// Mean square of its standardised residuals: clocks and multipath differ.
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

    /// By what the variance of its phase is multiplied.
    pub(crate) fn variance_factor(&self) -> f64 {
        self.noise.clamp(1.0, nt())
    }

    /// Whether the ambiguity must be another one: the phase jumped and stays where it is for
    /// `patience` epochs, or at once where its own observations are `suspicious`.
    pub(crate) fn contradicts(&self, patience: u8, suspicious: bool) -> bool {
        let long = self.unheard >= patience.saturating_mul(ENDURANCE);
        let jumped = self.jumped && self.unheard >= patience;
        long || jumped || (suspicious && self.unheard > 0)
    }

    /// The ambiguity begins anew.
    pub(crate) fn begin(&mut self) {
        *self = Self { noise: self.noise, ..Self::NEW };
    }

    /// Remembers what became of the phase of an epoch, whose variance by itself is `variance`.
    pub(crate) fn listen(&mut self, phase: &Decision<f64>, variance: f64, common: f64) {
        if phase.weight > UNHEARD {
            (self.unheard, self.jumped, self.residual) = (0, false, phase.residual);
        } else {
            if self.unheard == 0 {
                let jump = phase.residual - self.residual;
                self.jumped = jump * jump > JUMP * JUMP * 2.0 * variance;
            }
            self.unheard = self.unheard.saturating_add(1);
        }
        if !matches!(phase.reason, Reason::NoRedundancy | Reason::TooFew) {
            let square = (phase.standardised * phase.standardised / common).min(LOUDEST);
            self.noise += (square * self.variance_factor() - self.noise) / MEMORY;
        }
    }
}

pub(crate) fn nt() -> f64 { use std::sync::OnceLock; static X: OnceLock<f64> = OnceLock::new(); *X.get_or_init(|| std::env::var("NT").ok().and_then(|v| v.parse().ok()).unwrap_or(9.0)) }
