//! One pass through the measurements of an epoch.

use crate::bias::Bias;
use crate::{Decision, Error, Measurement, Reason};
use kestirim_kalman::Gaussian;
use kestirim_scalar::Scalar;

/// Result of a pass, apart from the estimate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passed<T> {
    /// εᵀ Qε⁻¹ ε of the measurements used.
    pub(crate) nis: T,
    /// Number of measurements used.
    pub(crate) used: usize,
}

/// Takes the measurements of an epoch, with their weights, into the prediction one after the other.
pub(crate) fn pass<T: Scalar, const N: usize>(
    prior: &Gaussian<T, N>,
    next: &mut Gaussian<T, N>,
    measurements: &[Measurement<'_, T>],
    decisions: &mut [Decision<T>],
    mut bias: Option<&mut Bias<T, N>>,
) -> Result<Passed<T>, Error> {
    *next = *prior;
    let mut passed = Passed { nis: T::ZERO, used: 0 };
    for (measurement, decision) in measurements.iter().zip(decisions) {
        if decision.weight <= T::ZERO {
            continue;
        }
        let left = measurement.left(prior, next);
        let mut weighed = next.weigh_entries(measurement.row, left, measurement.variance)?;
        if decision.weight < T::ONE {
            let Ok(lighter) = weighed.with_noise(measurement.variance / decision.weight) else {
                // The weight is so small that the variance overflows: treated as no weight.
                (decision.weight, decision.reason) = (T::ZERO, Reason::Rejected);
                continue;
            };
            weighed = lighter;
        }
        if let Some(bias) = &mut bias {
            bias.take(measurement, &weighed);
        }
        passed.nis += next.correct(&weighed)?.nis;
        passed.used += 1;
    }
    Ok(passed)
}
