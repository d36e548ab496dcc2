//! Statistics and weights from the residuals of one pass.

use crate::pass::Passed;
use crate::student::whole;
use crate::{AnyFactor, AnyScale, Decision, Measurement, Reason, Robust, WeightFunction};
use kestirim_kalman::Gaussian;
use kestirim_scalar::Scalar;

/// State of an epoch between two passes.
pub(crate) struct Epoch<'a, 'b, T: Scalar, const N: usize> {
    pub(crate) prior: &'a Gaussian<T, N>,
    pub(crate) posterior: &'a Gaussian<T, N>,
    pub(crate) measurements: &'a [Measurement<'b, T>],
}

impl<T: Scalar, W: WeightFunction<T>, S: AnyScale<T>, A: AnyFactor<T>> Robust<T, W, S, A> {
    /// Computes ṽ and the statistic of every measurement that has not been treated yet, with σ̂0 = `known` if that is
    /// given. Returns σ̂0.
    #[inline(never)] // Called before, between and after passes: one copy of the code.
    pub(crate) fn judge<const N: usize>(
        &self,
        epoch: &Epoch<'_, '_, T, N>,
        passed: &Passed<T>,
        known: Option<T>,
        decisions: &mut [Decision<T>],
    ) -> T {
        for (measurement, decision) in epoch.measurements.iter().zip(&mut *decisions) {
            if !decision.was_treated() {
                let left = measurement.variance - measurement.spread(epoch.posterior);
                decision.residual = measurement.left(epoch.prior, epoch.posterior);
                self.standardise(measurement, left, decision);
            }
        }
        self.compare(passed, known, decisions)
    }

    /// Computes the statistics of all decisions that hold v/√Qᵥ, with σ̂0 = `known` if that is given. Returns σ̂0.
    #[inline(never)] // Called from several places: one copy of the code.
    pub(crate) fn compare(
        &self,
        passed: &Passed<T>,
        known: Option<T>,
        decisions: &mut [Decision<T>],
    ) -> T {
        let scale = known.unwrap_or_else(|| self.scale.choice().of_residuals(passed, decisions));
        let divisor = scale.divisor();
        for decision in &mut *decisions {
            if decision.counts() {
                decision.standardised = decision.standardised.divided_by(divisor);
                decision.statistic = decision.standardised.abs();
            }
        }
        let count = decisions.iter().filter(|decision| decision.counts()).count();
        let thresholds = self.weight.thresholds(count);
        if self.weight.is_t_test() {
            compare_with_others(decisions, count);
        }
        for decision in decisions {
            if decision.counts() {
                (decision.reason, decision.thresholds) = match thresholds {
                    Some(thresholds) => (Reason::Agrees, thresholds),
                    None => (Reason::TooFew, (T::ZERO, T::ZERO)),
                };
            }
        }
        scale
    }

    /// Computes v/√Qᵥ of a residual v with Qᵥ = R − h P⁺ hᵀ, provided that Qᵥ/R is above the least redundancy.
    #[inline(never)] // Called from several places: one copy of the code.
    pub(crate) fn standardise(
        &self,
        measurement: &Measurement<'_, T>,
        left: T,
        decision: &mut Decision<T>,
    ) {
        let variance = measurement.variance;
        decision.redundancy = (left / variance).max(T::ZERO);
        if left > self.least_redundancy * variance {
            decision.standardised = decision.residual / left.sqrt();
            decision.reason = Reason::Agrees;
        } else {
            (decision.standardised, decision.statistic) = (T::ZERO, T::ZERO);
            decision.thresholds = (T::ZERO, T::ZERO);
            decision.reason = Reason::NoRedundancy;
        }
    }

    /// The reduced weight that a judged measurement is to have; `None` if it keeps its full weight.
    pub(crate) fn lighter(&self, decision: &Decision<T>) -> Option<T> {
        if decision.reason != Reason::Agrees {
            return None;
        }
        let weight = self.weight.factor(decision.statistic, decision.thresholds);
        if weight >= T::ONE { None } else { Some(weight) }
    }

    /// Gives a judged measurement its weight. Returns whether the weight changed.
    pub(crate) fn treat(&self, decision: &mut Decision<T>) -> bool {
        let weight = self.lighter(decision);
        if let Some(weight) = weight {
            decision.lose(weight);
        }
        weight.is_some()
    }
}

/// T (20): the distance of each ṽ from the mean of the others, in units of their standard deviation.
fn compare_with_others<T: Scalar>(decisions: &mut [Decision<T>], count: usize) {
    if count < 3 {
        return;
    }
    let others = whole::<T>(count - 1).divisor();
    let freedom = whole::<T>(count - 2).divisor();
    for index in 0..decisions.len() {
        let Some(judged) = decisions.get(index).filter(|decision| decision.counts()).copied()
        else {
            continue;
        };
        let values = || {
            let rest =
                decisions.iter().enumerate().filter(|(other, d)| *other != index && d.counts());
            rest.map(|(_, decision)| decision.standardised)
        };
        let mean = values().fold(T::ZERO, |sum, value| sum + value.divided_by(others));
        let square = values().fold(T::ZERO, |sum, value| {
            sum + ((value - mean) * (value - mean)).divided_by(freedom)
        });
        let distance = (judged.standardised - mean).abs();
        let deviation = square.sqrt();
        // Where all values are equal, none stands out, even if the deviation is zero.
        let statistic = if distance > T::ZERO { distance / deviation } else { T::ZERO };
        if let Some(decision) = decisions.get_mut(index) {
            decision.statistic = statistic;
        }
    }
}
