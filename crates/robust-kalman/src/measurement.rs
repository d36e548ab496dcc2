use kestirim_kalman::{Gaussian, SparseRow};
use kestirim_scalar::{Components, Scalar};

/// A scalar measurement of an epoch, linearised at the predicted state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement<'a, T> {
    /// h = ∂h/∂x⁻ as pairs of a state's index and the derivative with respect to it; states not
    /// named have derivative zero.
    pub row: &'a [(usize, T)],
    /// ε = z − h(x⁻), the innovation at the prediction, for all measurements of the epoch alike.
    pub innovation: T,
    /// R, the variance of the noise, in the measurement's unit squared.
    pub variance: T,
}

impl<'a, T: Scalar> Measurement<'a, T> {
    /// A measurement with a [`SparseRow`] of `kestirim_kalman`.
    pub const fn new<const K: usize>(row: &'a SparseRow<T, K>, innovation: T, variance: T) -> Self {
        Self { row: row.entries(), innovation, variance }
    }

    /// ε − h·(x − x⁻): the innovation relative to another mean x. Indices beyond the state count
    /// as zeros: the update has already refused them.
    #[inline(always)]
    pub(crate) fn left<const N: usize>(&self, prior: &Gaussian<T, N>, now: &Gaussian<T, N>) -> T {
        // In fixed point the difference would leave the rail, and be taken for a measurement.
        if !(T::IS_FLOAT || self.innovation.is_finite()) {
            return self.innovation;
        }
        let (before, after) = (prior.mean.as_array(), now.mean.as_array());
        let mut sum = T::accumulator();
        for &(index, value) in self.row {
            if let (Some(&before), Some(&after)) = (before.get(index), after.get(index)) {
                sum = T::mac(sum, value, after - before);
            }
        }
        self.innovation - T::finish(sum)
    }

    /// h P hᵀ, the variance of the expected measurement.
    #[inline(always)]
    pub(crate) fn spread<const N: usize>(&self, estimate: &Gaussian<T, N>) -> T {
        let mut spread = T::accumulator();
        for (place, &(i, a)) in self.row.iter().enumerate() {
            let mut cross = T::accumulator();
            for &(j, b) in self.row.get(..place).unwrap_or(&[]) {
                cross = T::mac(cross, b, estimate.covariance.get(i, j).unwrap_or(T::ZERO));
            }
            let own = a * estimate.covariance.get(i, i).unwrap_or(T::ZERO);
            spread = T::mac(spread, a, own + T::TWO * T::finish(cross));
        }
        T::finish(spread).max(T::ZERO)
    }
}
