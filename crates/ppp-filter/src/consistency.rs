//! How well the observations of the last epochs agree with the solution.

use kestirim_robust_kalman::{Decision, Reason};

/// What remains of an epoch in the sums after the next one: a memory of ten epochs.
const KEPT: f64 = 0.9;
/// Epochs before anything is judged.
const FIRST: u8 = 10;
/// Largest share of rejected observations: days with fifteen outliers in a thousand and big slips reach 0.20 in their
/// worst minutes and are solved well; swapped codes pass 0.35.
const LARGEST_SHARE: f64 = 0.22;
/// Largest mean of the squared standardised residuals. Residuals of an epoch are those of the next, as clocks and
/// troposphere go slowly, so that good days with old clocks pass the bound of white noise and reach 6.
const LARGEST_SQUARE: f64 = 8.0;
/// Largest square of one residual: a single outlier is none of all.
const LARGEST_SINGLE: f64 = 100.0;

/// Sums over the last epochs, each epoch counted for less than the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Consistency {
    epochs: u8,
    judged: f64,
    rejected: f64,
    squares: f64,
}

impl Consistency {
    /// Takes in what was decided about the observations of an epoch.
    pub(crate) fn update<'a>(&mut self, decisions: impl Iterator<Item = &'a Decision<f64>>) {
        self.epochs = self.epochs.saturating_add(1);
        for sum in [&mut self.judged, &mut self.rejected, &mut self.squares] {
            *sum *= KEPT;
        }
        for decision in decisions {
            match decision.reason {
                Reason::NoRedundancy | Reason::TooFew => continue,
                Reason::Rejected => self.rejected += 1.0,
                _ => {
                    let square = decision.standardised * decision.standardised;
                    self.squares += square.min(LARGEST_SINGLE);
                }
            }
            self.judged += 1.0;
        }
    }

    /// Whether the observations contradict the solution, or each other: more than a fifth of them is rejected, or what
    /// is left is almost three times as far from the solution as its noise.
    pub(crate) fn is_contradicted(&self) -> bool {
        self.epochs >= FIRST
            && (self.rejected > LARGEST_SHARE * self.judged
                || self.squares > LARGEST_SQUARE * (self.judged - self.rejected))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decision(reason: Reason, standardised: f64) -> Decision<f64> {
        Decision { reason, standardised, ..Decision::NONE }
    }

    fn after(epochs: usize, decisions: &[Decision<f64>]) -> Consistency {
        let mut consistency = Consistency::default();
        (0..epochs).for_each(|_| consistency.update(decisions.iter()));
        consistency
    }

    #[test]
    fn noise_is_consistent() {
        let quiet = [decision(Reason::Agrees, 1.0); 20];
        assert!(!after(100, &quiet).is_contradicted());
        let loud = [decision(Reason::Agrees, 3.1); 20];
        assert!(!after(9, &loud).is_contradicted());
        assert!(after(10, &loud).is_contradicted());
    }

    #[test]
    fn one_outlier_is_nobodys_fault_and_a_quarter_of_all_is() {
        let mut epoch = [decision(Reason::Agrees, 1.0); 20];
        epoch[0] = decision(Reason::Rejected, 1e3);
        assert!(!after(100, &epoch).is_contradicted());
        epoch[1..5].fill(decision(Reason::Rejected, 1e3));
        assert!(after(100, &epoch).is_contradicted());
    }

    #[test]
    fn a_fault_that_is_over_is_forgotten() {
        let mut consistency = after(100, &[decision(Reason::Rejected, 1e3); 20]);
        assert!(consistency.is_contradicted());
        for _ in 0..30 {
            consistency.update([decision(Reason::Agrees, 1.0); 20].iter());
        }
        assert!(!consistency.is_contradicted());
        // Without redundancy nothing is judged.
        assert!(!after(100, &[decision(Reason::NoRedundancy, 0.0); 8]).is_contradicted());
    }
}
