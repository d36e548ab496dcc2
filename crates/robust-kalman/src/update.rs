//! The update itself: the sequence of passes and judgements.

use crate::bias::{Bias, Jump};
use crate::judge::Epoch;
use crate::pass::{Passed, pass};
use crate::worst_first::Judged;
use crate::{
    Adaptive, AnyFactor, AnyScale, Block, Decision, Discrepancy, Error, Measurement, Order, Reason,
};
use crate::{Reweighting, Robust, Summary, WeightFunction};
use kestirim_kalman::Gaussian;
use kestirim_scalar::Scalar;

impl<T: Scalar, W: WeightFunction<T>, S: AnyScale<T>, A: AnyFactor<T>> Robust<T, W, S, A> {
    /// Takes the measurements of an epoch into a predicted estimate, with a decision about each.
    ///
    /// All innovations are relative to the prediction. `decisions` needs a place for each measurement; its previous
    /// contents do not matter, and further places stay as they are.
    ///
    /// # Errors
    /// [`Error`]; the estimate is untouched, and the decisions are meaningless.
    pub fn update<const N: usize>(
        &self,
        estimate: &mut Gaussian<T, N>,
        measurements: &[Measurement<'_, T>],
        decisions: &mut [Decision<T>],
    ) -> Result<Summary<T>, Error> {
        let decisions = decisions.get_mut(..measurements.len()).ok_or(Error::TooFewDecisions)?;
        if !self.is_valid() {
            return Err(Error::InvalidConfiguration);
        }
        let adaptive = self.adaptive.choice().filter(|_| A::POSSIBLE);
        if let Some(adaptive) = &adaptive {
            adaptive.block.check::<N>()?;
        }
        decisions.fill(Decision::NONE);
        let mut run = Run {
            robust: self,
            bias: adaptive.and_then(|adaptive| adaptive.bias(estimate)),
            prior: *estimate,
            posterior: *estimate,
            measurements,
            passes: 0,
        };
        let passed = run.pass(decisions)?;
        let nis = passed.nis;
        let judged = match &adaptive {
            None => Adapted { scale: run.reweight(passed, decisions)?, ..Adapted::default() },
            Some(adaptive) => run.adapt(adaptive, passed, decisions)?,
        };
        // A noise-free measurement of a state that barely moves it: rounding of the gain in fixed point may subtract
        // more variance than there is.
        if run.posterior.covariance.variances().iter().any(|&variance| variance < T::ZERO) {
            return Err(kestirim_kalman::Error::NotPositive.into());
        }
        for (measurement, decision) in measurements.iter().zip(&mut *decisions) {
            decision.residual = measurement.left(&run.prior, &run.posterior);
        }
        *estimate = run.posterior;
        let of = |reason| decisions.iter().filter(|decision| decision.reason == reason).count();
        Ok(Summary {
            nis,
            scale: judged.scale,
            down_weighted: of(Reason::DownWeighted),
            rejected: of(Reason::Rejected),
            passes: run.passes,
            discrepancy: judged.discrepancy,
            adaptive_factor: judged.factor,
        })
    }
}

/// Distance of a block of the state from its prediction, according to the epoch's measurements, all with full weight.
///
/// Detects a motion before measurements are judged by the prediction; the estimate is not changed.
///
/// # Errors
/// [`Error::InvalidBlock`] or [`Error::Estimate`].
pub fn jump<T: Scalar, const N: usize>(
    estimate: &Gaussian<T, N>,
    measurements: &[Measurement<'_, T>],
    block: Block,
) -> Result<Jump<T>, Error> {
    block.check::<N>()?;
    let mut bias = Bias::new(estimate, block);
    let mut posterior = *estimate;
    for measurement in measurements {
        let left = measurement.left(estimate, &posterior);
        let weighed = posterior.weigh_entries(measurement.row, left, measurement.variance)?;
        bias.take(measurement, &weighed);
        posterior.correct(&weighed)?;
    }
    Ok(bias.jump())
}

impl<T: Scalar> Adaptive<T> {
    fn bias<const N: usize>(&self, prior: &Gaussian<T, N>) -> Option<Bias<T, N>> {
        let wanted = self.discrepancy != Discrepancy::Innovation;
        wanted.then(|| Bias::new(prior, self.block))
    }
}

/// Result of judging an epoch and its prediction: σ̂0, the statistic of the adaptive factor, and the factor.
struct Adapted<T> {
    scale: T,
    discrepancy: T,
    factor: T,
}

impl<T: Scalar> Default for Adapted<T> {
    fn default() -> Self {
        Self { scale: T::ONE, discrepancy: T::ZERO, factor: T::ONE }
    }
}

/// Whether more than a third of the measurements that could be judged were down-weighted or rejected.
fn many_are_off<T: Scalar>(decisions: &[Decision<T>]) -> bool {
    let treated = decisions.iter().filter(|decision| decision.was_treated()).count();
    let agreeing = decisions.iter().filter(|decision| decision.counts()).count();
    treated > agreeing / 2
}

/// State of an update while the measurements of its epoch are judged.
pub(crate) struct Run<'a, 'b, T: Scalar, W, S, A, const N: usize> {
    pub(crate) robust: &'a Robust<T, W, S, A>,
    pub(crate) prior: Gaussian<T, N>,
    pub(crate) posterior: Gaussian<T, N>,
    pub(crate) measurements: &'a [Measurement<'b, T>],
    /// Least squares for the block's jump, present while the adaptive factor needs it.
    bias: Option<Bias<T, N>>,
    passes: usize,
}

impl<'b, T: Scalar, W: WeightFunction<T>, S: AnyScale<T>, A: AnyFactor<T>, const N: usize>
    Run<'_, 'b, T, W, S, A, N>
{
    #[inline(never)] // Called at several places.
    pub(crate) fn pass(&mut self, decisions: &mut [Decision<T>]) -> Result<Passed<T>, Error> {
        self.passes += 1;
        let mut bias = self.bias.as_mut().filter(|_| A::POSSIBLE);
        if let Some(bias) = &mut bias {
            **bias = Bias::new(&self.prior, bias.block());
        }
        pass(&self.prior, &mut self.posterior, self.measurements, decisions, bias)
    }

    /// Judges and weights the measurements by the chosen iteration. Returns σ̂0.
    fn reweight(&mut self, passed: Passed<T>, decisions: &mut [Decision<T>]) -> Result<T, Error> {
        let known = self.robust.scale.choice().of_innovations(&self.epoch(), decisions);
        let scale = self.robust.judge(&self.epoch(), &passed, known, decisions);
        match self.robust.reweighting {
            Reweighting::Never => {}
            Reweighting::OneShot => {
                let mut changed = false;
                for decision in &mut *decisions {
                    changed |= self.robust.treat(decision);
                }
                if changed {
                    self.pass(decisions)?;
                }
            }
            Reweighting::WorstFirst { most } => {
                return self.worst_first(most, Judged { passed, known, scale }, decisions);
            }
        }
        Ok(scale)
    }

    /// Applies [`Run::reweight`] and the adaptive factor in the chosen order.
    fn adapt(
        &mut self,
        adaptive: &Adaptive<T>,
        passed: Passed<T>,
        decisions: &mut [Decision<T>],
    ) -> Result<Adapted<T>, Error> {
        let mut judged = Adapted::default();
        let unweighted = self.discrepancy(adaptive, decisions);
        let mut dynamics_first = adaptive.order == Order::BeforeWeights;
        if !dynamics_first {
            judged.scale = self.reweight(passed, decisions)?;
            dynamics_first = adaptive.order == Order::ByMajority && many_are_off(decisions);
        }
        judged.discrepancy =
            if dynamics_first { unweighted } else { self.discrepancy(adaptive, decisions) };
        judged.factor = adaptive.factor(judged.discrepancy);
        self.bias = None;
        let mut passed = passed;
        if judged.factor < T::ONE {
            if dynamics_first {
                decisions.fill(Decision::NONE);
            }
            self.inflate(adaptive.block, judged.factor)?;
            passed = self.pass(decisions)?;
        } else if adaptive.order == Order::ByMajority {
            return Ok(judged);
        }
        if dynamics_first {
            judged.scale = self.reweight(passed, decisions)?;
        }
        Ok(judged)
    }

    pub(crate) fn epoch(&self) -> Epoch<'_, 'b, T, N> {
        Epoch { prior: &self.prior, posterior: &self.posterior, measurements: self.measurements }
    }

    fn discrepancy(&self, adaptive: &Adaptive<T>, decisions: &[Decision<T>]) -> T {
        match (adaptive.discrepancy, &self.bias) {
            (Discrepancy::Block, Some(bias)) => bias.jump().discrepancy,
            (Discrepancy::Prediction, Some(bias)) => bias.in_deviations(&bias.jump()),
            _ => self.of_innovations(decisions),
        }
    }

    /// √(εᵀε / tr Qε) of the measurements with positive weight.
    fn of_innovations(&self, decisions: &[Decision<T>]) -> T {
        let (mut square, mut trace) = (T::ZERO, T::ZERO);
        for (measurement, decision) in self.measurements.iter().zip(decisions) {
            if decision.weight > T::ZERO {
                square += measurement.innovation * measurement.innovation;
                trace += measurement.spread(&self.prior) + measurement.variance / decision.weight;
            }
        }
        if trace > T::ZERO { (square / trace).sqrt() } else { T::ZERO }
    }

    /// Divides the block's covariance by the factor a.
    fn inflate(&mut self, block: Block, factor: T) -> Result<(), Error> {
        self.prior.covariance.inflate(block.first, block.count, factor.recip())?;
        Ok(())
    }
}
