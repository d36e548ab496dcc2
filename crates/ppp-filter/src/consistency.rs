//! How well the observations of the last epochs agree with the solution.

use crate::Contradiction;
use kestirim_robust_kalman::{Decision, Reason};

/// What remains of an epoch in the sums after the next one: a memory of ten epochs.
const KEPT: f64 = 0.9;
/// Epochs before anything but gross contradictions is judged, and for which a smaller one must last.
const FIRST: u8 = 10;
/// Largest share of rejected observations that may last. Clean days stay below 0.05, of the t-test below 0.11.
const LARGEST_SHARE: f64 = 0.10;
/// Largest share at all: swapped codes pass 0.35.
const GROSS_SHARE: f64 = 0.22;
/// Largest mean of the squared standardised residuals that may last. Those of an epoch are those of the next, as clocks
/// and troposphere go slowly: a window of ten epochs holds not many more than four independent ones, whose mean is
/// below 4.6 in 99.9 % of all cases if the noise is as said. Old clocks make it larger: good days pass 6 for some
/// minutes.
const LARGEST_SQUARE: f64 = 7.0;
/// Largest mean at all.
const GROSS_SQUARE: f64 = 8.0;
/// Largest mean in the first epochs, of fewer numbers …
const FIRST_SQUARE: f64 = 20.0;
/// … and largest share.
const FIRST_SHARE: f64 = 0.30;
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
    /// For how many epochs more was rejected than may last …
    rejecting: u8,
    /// … and residuals were larger.
    loud: u8,
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
        let longer = |epochs: u8, is: bool| if is { epochs.saturating_add(1) } else { 0 };
        self.rejecting = longer(self.rejecting, self.rejects(LARGEST_SHARE));
        self.loud = longer(self.loud, self.exceeds(LARGEST_SQUARE));
    }

    /// Why the observations contradict the solution, or each other: too many are rejected, or what is left is too far
    /// from the solution.
    pub(crate) fn contradiction(&self) -> Option<Contradiction> {
        let begins = self.epochs < FIRST;
        let (share, square) =
            if begins { (FIRST_SHARE, FIRST_SQUARE) } else { (GROSS_SHARE, GROSS_SQUARE) };
        if self.exceeds(square) || self.loud >= FIRST {
            Some(Contradiction::Residuals)
        } else if self.rejects(share) || self.rejecting >= FIRST {
            Some(Contradiction::Rejections)
        } else {
            None
        }
    }

    fn rejects(&self, share: f64) -> bool {
        self.rejected > share * self.judged
    }

    fn exceeds(&self, square: f64) -> bool {
        self.squares > square * (self.judged - self.rejected)
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
        assert!(after(100, &quiet).contradiction().is_none());
        for (deviations, epochs) in [(5.0, 1), (3.1, 10), (2.8, 10)] {
            let loud = [decision(Reason::Agrees, deviations); 20];
            let found = |epochs| after(epochs, &loud).contradiction();
            assert_eq!(found(epochs), Some(Contradiction::Residuals), "{deviations}");
            assert_eq!(found(epochs - 1), None, "{deviations}");
        }
    }

    #[test]
    fn one_outlier_is_nobodys_fault_and_more_than_a_tenth_of_all_is() {
        let mut epoch = [decision(Reason::Agrees, 1.0); 20];
        epoch[0] = decision(Reason::Rejected, 1e3);
        assert_eq!(after(100, &epoch).contradiction(), None);
        epoch[1..3].fill(decision(Reason::Rejected, 1e3));
        assert_eq!(after(9, &epoch).contradiction(), None);
        assert_eq!(after(10, &epoch).contradiction(), Some(Contradiction::Rejections));
        epoch[3..8].fill(decision(Reason::Rejected, 1e3));
        assert_eq!(after(1, &epoch).contradiction(), Some(Contradiction::Rejections));
    }

    #[test]
    fn a_fault_that_is_over_is_forgotten() {
        let mut consistency = after(100, &[decision(Reason::Rejected, 1e3); 20]);
        assert!(consistency.contradiction().is_some());
        for _ in 0..30 {
            consistency.update([decision(Reason::Agrees, 1.0); 20].iter());
        }
        assert_eq!(consistency.contradiction(), None);
        // Without redundancy nothing is judged.
        assert_eq!(after(100, &[decision(Reason::NoRedundancy, 0.0); 8]).contradiction(), None);
    }
}
