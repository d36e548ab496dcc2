//! Treatment of one outlier after the other, each at the cost of one update.

use crate::pass::Passed;
use crate::update::Run;
use crate::{AnyFactor, AnyScale, Decision, Error, Reason, WeightFunction};
use kestirim_scalar::{Components, Scalar};

/// An epoch whose measurements have been judged.
pub(crate) struct Judged<T> {
    pub(crate) passed: Passed<T>,
    /// σ̂0 if it comes from the innovations.
    pub(crate) known: Option<T>,
    /// σ̂0 as last used.
    pub(crate) scale: T,
}

/// What has been released from the estimate since the last pass.
#[derive(Clone, Copy, PartialEq)]
enum Released {
    None,
    DownWeighted,
    Rejected,
}

/// Largest error, σ, that a release may leave behind in the residuals of the others.
const MOST_LEFT: f64 = 1.0 / 1024.0;
/// Smallest share of the sum of squares that may remain: below it, the remainder would be nothing but rounding.
const LEAST_NIS: f64 = 1.0 / 1024.0;

impl<T: Scalar, W: WeightFunction<T>, S: AnyScale<T>, A: AnyFactor<T>, const N: usize>
    Run<'_, '_, T, W, S, A, N>
{
    /// Treats the worst measurement alone, repeatedly. While others are suspected, it is only released from the
    /// estimate, which costs one update; when none is left, everything is computed anew and judged once more.
    pub(crate) fn worst_first(
        &mut self,
        most: usize,
        mut judged: Judged<T>,
        decisions: &mut [Decision<T>],
    ) -> Result<T, Error> {
        // Each measurement is treated at most once.
        let mut treatable = most.min(decisions.len());
        let mut released = Released::None;
        loop {
            let suspects = decisions.iter().filter(|decision| decision.is_suspect()).count();
            let worst = worst(decisions).filter(|_| treatable > 0);
            let place = worst.and_then(|index| decisions.get_mut(index));
            let weight = place.as_ref().and_then(|decision| self.robust.lighter(decision));
            if let (Some(index), Some(place), Some(weight)) = (worst, place, weight) {
                let rejected = weight <= T::ZERO;
                // A rejected outlier leaves rounding behind when released, which would affect a reduced weight.
                if rejected || released != Released::Rejected {
                    place.lose(weight);
                    treatable -= 1;
                    let next = suspects > 1 && treatable > 0;
                    if next && self.release(index, &mut judged.passed, decisions) {
                        judged.scale = self.robust.compare(&judged.passed, judged.known, decisions);
                        released =
                            if rejected { Released::Rejected } else { Released::DownWeighted };
                        continue;
                    }
                }
            } else if released == Released::None {
                return Ok(judged.scale);
            }
            judged.passed = self.pass(decisions)?;
            let Judged { passed, known, .. } = &judged;
            judged.scale = self.robust.judge(&self.epoch(), passed, *known, decisions);
            released = Released::None;
        }
    }

    /// Removes from the estimate what a treated measurement has lost of its weight, and corrects the residuals and
    /// redundancies of the others. R/γ in place of R is equivalent to another measurement of variance −R/(1 − γ): its S
    /// is negative, and P grows. Returns whether that was possible and exact enough: a treated measurement is never
    /// judged again.
    #[inline(never)] // Keeps its registers out of the path without outliers.
    fn release(
        &mut self,
        index: usize,
        passed: &mut Passed<T>,
        decisions: &mut [Decision<T>],
    ) -> bool {
        let treated = self.measurements.get(index).zip(decisions.get(index).copied());
        let Some((measurement, Decision { weight, residual, redundancy, .. })) = treated else {
            return false;
        };
        // R/(1 − γ) − h P⁺ hᵀ.
        let variance = measurement.variance;
        let left = variance / (T::ONE - weight) - (variance - redundancy * variance);
        // Rounding is magnified by R over this value: where little is left, a pass is more exact.
        if !(left.is_finite() && left * T::from_f64(8.0) > variance) {
            return false;
        }
        let root = left.sqrt().divisor();
        let pull = residual.divided_by(root);
        let nis = passed.nis - pull * pull;
        let (largest, least) = (T::from_f64(MOST_LEFT), T::from_f64(LEAST_NIS));
        if !(pull.abs() * self.rounding() < largest && nis > passed.nis * least) {
            return false;
        }
        let mut step = [T::ZERO; N];
        let mean = self.posterior.mean.as_array_mut();
        for (state, (step, mean)) in step.iter_mut().zip(mean).enumerate() {
            let mut cross = T::accumulator();
            for &(index, value) in measurement.row {
                let entry = self.posterior.covariance.get(index, state).unwrap_or(T::ZERO);
                cross = T::mac(cross, value, entry);
            }
            *step = T::finish(cross).divided_by(root);
            *mean -= *step * pull;
        }
        self.posterior.covariance.add_outer(&step.into());
        passed.nis = nis;
        passed.used -= usize::from(weight <= T::ZERO).min(passed.used);
        for (measurement, decision) in self.measurements.iter().zip(decisions) {
            if decision.counts() {
                let mut shown = T::accumulator();
                for &(index, value) in measurement.row {
                    shown = T::mac(shown, value, step.get(index).copied().unwrap_or(T::ZERO));
                }
                let shown = T::finish(shown);
                decision.residual += shown * pull;
                let left = decision.redundancy * measurement.variance - shown * shown;
                self.robust.standardise(measurement, left, decision);
            }
        }
        true
    }
}

impl<T: Scalar, W, S, A, const N: usize> Run<'_, '_, T, W, S, A, N> {
    /// Relative error of the posterior covariance: that of N sums, magnified where a variance has shrunk much. In fixed
    /// point, whose resolution is the same for large and small numbers, releases are ruled out, and passes are made
    /// instead.
    fn rounding(&self) -> T {
        if !T::IS_FLOAT {
            return T::MAX;
        }
        let variances = self.prior.covariance.variances();
        let left = self.posterior.covariance.variances();
        let shares = variances.iter().zip(left.iter()).map(|(&before, &after)| before / after);
        let most = shares.fold(T::ONE, |most, share| if share <= most { most } else { share });
        most * T::EPSILON * T::from_f64(N as f64)
    }
}

/// The index of the measurement with the largest statistic among those that were judged.
fn worst<T: Scalar>(decisions: &[Decision<T>]) -> Option<usize> {
    let mut worst: Option<(usize, T)> = None;
    for (index, decision) in decisions.iter().enumerate() {
        let further = worst.is_none_or(|(_, statistic)| decision.statistic > statistic);
        if decision.reason == Reason::Agrees && further {
            worst = Some((index, decision.statistic));
        }
    }
    worst.map(|(index, _)| index)
}
