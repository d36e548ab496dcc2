//! Gauss-Newton iterations from one start.

use crate::common_bias::CommonBias;
use crate::symmetric::NormalEquations;
use crate::{Error, Fix, Huber, Observation, Solver, expected_range};
use kestirim_scalar::{Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// The state of the iterations from one start.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub(crate) struct Descent<T: Scalar, const D: usize> {
    position: SVector<T, D>,
    bias: T,
    steps: u16,
}

/// The outcome of a step.
pub(crate) enum Step<T: Scalar, const D: usize> {
    /// One of the first steps, whose cost and length say nothing yet.
    First,
    /// An intermediate step: the cost before it and the length of the step (m).
    Next { cost: T, moved: T },
    /// A minimum.
    Settled(Fix<T, D>),
}

/// Convergence criteria for a minimum.
pub(crate) struct Care<T> {
    /// Steps no longer than this end the search, m.
    settled: T,
    /// Number of steps from which `slow` replaces `settled`.
    many: u16,
    /// The step length that ends the search after `many` steps, m.
    slow: T,
}

impl<T: Scalar> Care<T> {
    /// Criteria for convergence to a millimetre.
    pub(crate) fn exact() -> Self {
        let settled = T::from_f64(1e-3);
        Self { settled, many: 30, slow: settled }
    }

    /// Criteria for a filter's initial position: Huber's weights would take dozens of steps on contradictory
    /// ranges.
    pub(crate) fn rough() -> Self {
        Self { settled: T::from_f64(1e-2), many: 12, slow: T::from_f64(0.1) }
    }
}

impl<T: Scalar, const D: usize> Descent<T, D> {
    const MOST_STEPS: u16 = 30;
    /// Initial steps in which every range has its full weight, so that Huber's weights begin near the answer.
    const PLAIN_STEPS: u16 = 3;

    /// The state before the first step from `start` (m).
    pub(crate) fn from(start: SVector<T, D>) -> Self {
        Self { position: start, bias: T::ZERO, steps: 0 }
    }

    /// The current position, m.
    pub(crate) fn position(&self) -> &SVector<T, D> {
        &self.position
    }

    /// Takes the next step.
    ///
    /// # Errors
    /// [`Error::DegenerateGeometry`] or [`Error::NotConverged`] if no minimum can be reached from this start.
    pub(crate) fn step(
        &mut self,
        solver: &Solver<T>,
        observations: &[Observation<T>],
        noise: &Noise<T>,
        care: &Care<T>,
    ) -> Result<Step<T, D>, Error> {
        let prior = solver.common_bias.filter(|_| observations.len() > D + 1);
        let is_plain = self.steps < Self::PLAIN_STEPS;
        let robust = solver.huber.filter(|_| !is_plain);
        let mut equations = NormalEquations::<T, D>::new();
        let mut common = CommonBias::new();
        let mut cost = T::ZERO;
        for observation in observations {
            let expected = expected_range(&self.position, solver.height, &observation.anchor);
            let residual = observation.range - expected.distance - self.bias;
            let (weight, square) = noise.weighed(residual, observation.variance, robust);
            cost += square;
            equations.add(&expected.direction, residual, weight);
            if prior.is_some() {
                common.add(&expected.direction, residual, weight);
            }
        }
        let least = equations.least_pivot();
        if let Some(bias_sigma) = prior {
            let ratio = noise.sigma / bias_sigma;
            common.add(&[T::ZERO; D], -self.bias, ratio * ratio);
            cost += (self.bias / bias_sigma) * (self.bias / bias_sigma);
            common.eliminate_from(&mut equations);
        }
        let factors = equations.factorised_above(least).ok_or(Error::DegenerateGeometry)?;
        let moved = factors.solve(&equations.b);
        let moved_bias = if prior.is_some() { common.solve(&moved) } else { T::ZERO };
        let (moved, moved_bias) = limited(moved, moved_bias);
        for axis in 0..D {
            self.position.as_array_mut()[axis] += moved[axis];
        }
        self.bias += moved_bias;
        if !(T::all_finite(self.position.as_array()) && self.bias.is_finite()) {
            return Err(Error::NotConverged);
        }
        self.steps = self.steps.saturating_add(1);
        if self.steps <= Self::PLAIN_STEPS + 1 {
            return Ok(Step::First);
        }
        let moved = moved.iter().fold(moved_bias.abs(), |most, moved| most.max(moved.abs()));
        let least = if self.steps < care.many { care.settled } else { care.slow };
        if moved > least {
            let is_last = self.steps >= Self::MOST_STEPS;
            return if is_last { Err(Error::NotConverged) } else { Ok(Step::Next { cost, moved }) };
        }
        let inverse = factors.inverse();
        let common_bias_variance =
            if prior.is_some() { common.variance(&factors) * noise.variance } else { T::ZERO };
        Ok(Step::Settled(Fix {
            position: self.position,
            covariance: SMatrix::from_fn(|i, j| inverse[i][j] * noise.variance),
            common_bias: self.bias,
            common_bias_variance,
            cost,
            ambiguous: false,
        }))
    }
}

/// The noise of the best range, to which all weights are relative.
pub(crate) struct Noise<T> {
    variance: T,
    sigma: T,
    per_sigma: T,
}

impl<T: Scalar> Noise<T> {
    /// The noise of a best range with this variance, m².
    pub(crate) fn new(variance: T) -> Self {
        let sigma = variance.sqrt();
        Self { variance, sigma, per_sigma: sigma.recip() }
    }

    /// The weight and the cost of a residual with this variance. Roots and divisions are only taken where they
    /// change something: a processor without a floating-point unit spends most of a start here.
    fn weighed(&self, residual: T, variance: T, huber: Option<Huber<T>>) -> (T, T) {
        let alike = variance == self.variance;
        let weight = if alike { T::ONE } else { self.variance / variance };
        let mut deviations = residual.abs() * self.per_sigma;
        let square = deviations * deviations * weight;
        match huber.map(|huber| huber.threshold(residual)) {
            Some(threshold) if square > threshold * threshold => {
                if !alike {
                    deviations *= weight.sqrt();
                }
                let cost = threshold * (T::TWO * deviations - threshold);
                (weight * threshold / deviations, cost)
            }
            _ => (weight, square),
        }
    }
}

/// A step limited to 2 m: far from the answer, the distances are not linear.
fn limited<T: Scalar, const D: usize>(step: [T; D], bias: T) -> ([T; D], T) {
    let mut length = T::norm(&step);
    if bias != T::ZERO {
        length = T::norm(&[length, bias]);
    }
    if length <= T::TWO {
        return (step, bias);
    }
    let divisor = length.divisor();
    let shortened = |component| T::TWO * T::divided_by(component, divisor);
    (step.map(shortened), shortened(bias))
}
