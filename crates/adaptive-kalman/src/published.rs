use crate::Error;
use kestirim_kalman::{BlockInnovation, Covariance, Gaussian, Process};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// The adaptive filter with eqs 18 and 19 as published. **Unsafe to navigate by**: use
/// [`AdaptiveKalman`](crate::AdaptiveKalman).
///
/// `R ← α_R R + (1 − α_R)(ν νᵀ − H P⁻ Hᵀ)` (18),
/// `Q ← α_Q Q + (1 − α_Q) K ν νᵀ Kᵀ` (19).
///
/// Eq. 18 is a difference: with everyday constants it makes R indefinite in nine updates of ten,
/// where a textbook implementation diverges and this one answers
/// [`Error::Estimate`]`(`[`NotPositive`](kestirim_kalman::Error::NotPositive)`)`. Where R stays positive,
/// it does so by absorbing the innovation: R becomes large in exactly the direction in which
/// the estimate is wrong, and the filter stays where it was started, reporting a small P and an
/// inconspicuous NIS. That is how a filter started at the surveyed point "measures" it to 2 cm.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PublishedAdaptiveKalman<T: Scalar, const N: usize, const M: usize> {
    estimate: Gaussian<T, N>,
    process_noise: Covariance<T, N>,
    measurement_noise: Covariance<T, M>,
    forgetting_process: T,
    forgetting_measurement: T,
}

impl<T: Scalar, const N: usize, const M: usize> PublishedAdaptiveKalman<T, N, M> {
    /// Starts from x̂₀, P₀, Q₀ (over one step), R₀ and the forgetting factors of eqs 19 and 18.
    ///
    /// # Errors
    /// [`Error::InvalidLearning`] if a factor is not in 0..=1.
    pub fn new(
        estimate: Gaussian<T, N>,
        process_noise: Covariance<T, N>,
        measurement_noise: Covariance<T, M>,
        forgetting_process: T,
        forgetting_measurement: T,
    ) -> Result<Self, Error> {
        for factor in [forgetting_process, forgetting_measurement] {
            if !(T::ZERO <= factor && factor <= T::ONE) {
                return Err(Error::InvalidLearning);
            }
        }
        Ok(Self {
            estimate,
            process_noise,
            measurement_noise,
            forgetting_process,
            forgetting_measurement,
        })
    }

    /// The estimate.
    pub fn estimate(&self) -> &Gaussian<T, N> {
        &self.estimate
    }

    /// R as adapted so far, the covariance of the measurement noise.
    pub fn measurement_noise(&self) -> &Covariance<T, M> {
        &self.measurement_noise
    }

    /// Predicts by `process`, which must add no noise of its own, and adds Q.
    ///
    /// # Errors
    /// [`Error::Estimate`]; the filter is untouched.
    pub fn predict(&mut self, process: &impl Process<T, N>) -> Result<(), Error> {
        let mut next = self.estimate;
        next.advance(process)?;
        next.covariance.add(&self.process_noise);
        if !next.covariance.is_finite() {
            return Err(kestirim_kalman::Error::NotFinite.into());
        }
        self.estimate = next;
        Ok(())
    }

    /// Takes in M measurements with innovations ν = z − h(x) and rows H, and adapts R and Q.
    ///
    /// # Errors
    /// [`Error::Estimate`], with `NotPositive` if eq. 18 has made R indefinite. The filter is untouched.
    pub fn update(
        &mut self,
        rows: &SMatrix<T, M, N>,
        innovation: &SVector<T, M>,
    ) -> Result<BlockInnovation<T, M>, Error> {
        let mut next = *self;
        let report = next.estimate.update_block(rows, innovation, &self.measurement_noise)?;
        // ν νᵀ − H P⁻ Hᵀ = ν νᵀ − S + R.
        let sample = |i: usize, j: usize| {
            let expected = entry(&report.covariance, i, j) - entry(&self.measurement_noise, i, j);
            innovation.as_array()[i] * innovation.as_array()[j] - expected
        };
        next.measurement_noise =
            blend(&self.measurement_noise, self.forgetting_measurement, sample);
        // K ν is the change of the mean by the update.
        let moved = *(next.estimate.mean - self.estimate.mean).as_array();
        next.process_noise =
            blend(&self.process_noise, self.forgetting_process, |i, j| moved[i] * moved[j]);
        if !(next.measurement_noise.is_finite() && next.process_noise.is_finite()) {
            return Err(kestirim_kalman::Error::NotFinite.into());
        }
        *self = next;
        Ok(report)
    }
}

fn entry<T: Scalar, const D: usize>(covariance: &Covariance<T, D>, i: usize, j: usize) -> T {
    covariance.get(i, j).unwrap_or(T::ZERO)
}

/// α C + (1 − α) sample.
fn blend<T: Scalar, const D: usize>(
    covariance: &Covariance<T, D>,
    forgetting: T,
    sample: impl Fn(usize, usize) -> T,
) -> Covariance<T, D> {
    let mut blended = SMatrix::<T, D, D>::zeros();
    for column in 0..D {
        for row in column..D {
            let kept = T::mac(T::accumulator(), forgetting, entry(covariance, row, column));
            blended.as_columns_mut()[column][row] =
                T::finish(T::mac(kept, T::ONE - forgetting, sample(row, column)));
        }
    }
    Covariance::from_lower_triangle(&blended)
}
