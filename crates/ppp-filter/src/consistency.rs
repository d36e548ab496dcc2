//! How well the observations of the last epochs agree with the solution.

use crate::{Contradiction, Motion};
use kestirim_robust_kalman::{Decision, Reason};

/// The weight of an epoch in the sums decays by this factor per epoch: a memory of ten epochs.
const KEPT: f64 = 0.9;
/// The number of epochs before anything but gross contradictions is judged, and for which a smaller contradiction must
/// last.
const FIRST: u8 = 10;
/// The largest share of rejected observations that may last. Clean days stay below 0.05, with the t-test below 0.11.
const LARGEST_SHARE: f64 = 0.10;
/// The largest share of rejected observations at any time: swapped codes exceed 0.35.
const GROSS_SHARE: f64 = 0.22;
/// The largest mean of the squared standardised residuals that may last.
///
/// Residuals persist from epoch to epoch, as clocks and troposphere vary slowly: a window of ten epochs holds little
/// more than four independent sets, whose mean is below 4.6 in 99.9 % of all cases if the noise is as configured.
/// Outdated clocks enlarge it: good days exceed 6 for some minutes.
const LARGEST_SQUARE: f64 = 7.0;
/// The largest mean of the squared standardised residuals at any time.
const GROSS_SQUARE: f64 = 8.0;
/// The largest mean of the squared standardised residuals in the first epochs, which hold fewer values.
const FIRST_SQUARE: f64 = 20.0;
/// The largest share of rejected observations of one epoch, and in the first epochs: beyond it, which
/// ones are wrong is a guess, whatever the epochs before.
const EPOCH_SHARE: f64 = 0.30;
/// The unknowns of a moving receiver in each epoch: its coordinates and its clock.
const UNKNOWNS: f64 = 4.0;
/// The upper limit on one squared residual, so that a single outlier does not condemn all.
const LARGEST_SINGLE: f64 = 100.0;

/// Sums over the last epochs, in which older epochs count for less.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Consistency {
    epochs: u8,
    judged: f64,
    rejected: f64,
    squares: f64,
    /// The number of consecutive epochs with more rejections than may last.
    rejecting: u8,
    /// The number of consecutive epochs with larger residuals than may last.
    loud: u8,
    /// Whether more of the last epoch was rejected than of any may be.
    is_split: bool,
}

/// Whether it is a guess which `wrong` of `all` phases of a moving receiver are wrong. Another choice of as many has `all` − 2 `wrong` of the
/// others in common with this one. Up to four agree on some place and some clock, so that both choices may fit.
pub(crate) fn is_a_guess(wrong: f64, all: f64) -> bool {
    wrong > 1.0 && all - 2.0 * wrong <= UNKNOWNS
}

/// The observations of one epoch that were judged, and how many of them were rejected.
struct Judged {
    judged: f64,
    rejected: f64,
}

impl Consistency {
    /// Updates the sums with the decisions about an epoch's codes and phases.
    pub(crate) fn update<'a>(
        &mut self,
        codes: impl Iterator<Item = &'a Decision<f64>>,
        phases: impl Iterator<Item = &'a Decision<f64>>,
        motion: Motion,
    ) {
        self.epochs = self.epochs.saturating_add(1);
        for sum in [&mut self.judged, &mut self.rejected, &mut self.squares] {
            *sum *= KEPT;
        }
        let (codes, phases) = (self.add(codes), self.add(phases));
        self.is_split = codes.rejected + phases.rejected
            > EPOCH_SHARE * (codes.judged + phases.judged)
            || matches!(motion, Motion::Kinematic { .. })
                && is_a_guess(phases.rejected, phases.judged);
        let longer = |epochs: u8, is: bool| if is { epochs.saturating_add(1) } else { 0 };
        self.rejecting = longer(self.rejecting, self.rejects(LARGEST_SHARE));
        self.loud = longer(self.loud, self.exceeds(LARGEST_SQUARE));
    }

    fn add<'a>(&mut self, decisions: impl Iterator<Item = &'a Decision<f64>>) -> Judged {
        let mut all = Judged { judged: 0.0, rejected: 0.0 };
        for decision in decisions {
            match decision.reason {
                Reason::NoRedundancy | Reason::TooFew => continue,
                Reason::Rejected => all.rejected += 1.0,
                _ => {
                    let square = decision.standardised * decision.standardised;
                    self.squares += square.min(LARGEST_SINGLE);
                }
            }
            all.judged += 1.0;
        }
        self.judged += all.judged;
        self.rejected += all.rejected;
        all
    }

    /// The reason why the observations contradict the solution, or each other: too many are rejected, or the accepted
    /// ones are too far from the solution.
    pub(crate) fn contradiction(&self) -> Option<Contradiction> {
        let begins = self.epochs < FIRST;
        let (share, square) =
            if begins { (EPOCH_SHARE, FIRST_SQUARE) } else { (GROSS_SHARE, GROSS_SQUARE) };
        if self.exceeds(square) || self.loud >= FIRST {
            Some(Contradiction::Residuals)
        } else if self.rejects(share) || self.rejecting >= FIRST || self.is_split {
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
        (0..epochs).for_each(|_| consistency.update(decisions.iter(), [].iter(), Motion::Static));
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
    fn an_epoch_of_which_a_third_is_rejected_is_contradicted_whatever_was_before() {
        let mut consistency = after(100, &[decision(Reason::Agrees, 1.0); 20]);
        let mut epoch = [decision(Reason::Agrees, 1.0); 20];
        epoch[..6].fill(decision(Reason::Rejected, 1e3));
        consistency.update(epoch.iter(), [].iter(), Motion::Static);
        assert_eq!(consistency.contradiction(), None);
        let mut consistency = after(100, &[decision(Reason::Agrees, 1.0); 20]);
        epoch[6] = decision(Reason::Rejected, 1e3);
        consistency.update(epoch.iter(), [].iter(), Motion::Static);
        assert_eq!(consistency.contradiction(), Some(Contradiction::Rejections));
        consistency.update([decision(Reason::Agrees, 1.0); 20].iter(), [].iter(), Motion::Static);
        assert_eq!(consistency.contradiction(), None);
    }

    #[test]
    fn phases_of_a_moving_receiver_contradict_whatever_the_codes_say() {
        const MOVES: Motion = Motion::Kinematic { process_noise: 100.0 };
        let contradiction = |rejected: usize, all: usize, motion| {
            let codes = [decision(Reason::Agrees, 1.0); 12];
            let mut phases = codes;
            phases[..rejected].fill(decision(Reason::Rejected, 1e3));
            let mut consistency = after(100, &codes);
            consistency.update(codes.iter(), phases[..all].iter(), motion);
            consistency.contradiction()
        };
        // The place of a receiver at rest is known from before.
        assert_eq!(contradiction(4, 10, Motion::Static), None);
        // That of a moving one is not: two choices may have no more than four in common.
        for (rejected, all) in [(1, 6), (1, 5), (2, 9), (3, 11)] {
            assert_eq!(contradiction(rejected, all, MOVES), None, "{rejected} of {all}");
        }
        for (rejected, all) in [(2, 8), (3, 10), (4, 12)] {
            let found = contradiction(rejected, all, MOVES);
            assert_eq!(found, Some(Contradiction::Rejections), "{rejected} of {all}");
        }
    }

    #[test]
    fn a_fault_that_is_over_is_forgotten() {
        let mut consistency = after(100, &[decision(Reason::Rejected, 1e3); 20]);
        assert!(consistency.contradiction().is_some());
        for _ in 0..30 {
            consistency.update(
                [decision(Reason::Agrees, 1.0); 20].iter(),
                [].iter(),
                Motion::Static,
            );
        }
        assert_eq!(consistency.contradiction(), None);
        // Without redundancy no observation is judged.
        assert_eq!(after(100, &[decision(Reason::NoRedundancy, 0.0); 8]).contradiction(), None);
    }
}
