use kestirim_kalman::{Gaussian, SparseRow};
use kestirim_scalar::{Components, Scalar};

/// One scalar measurement of an epoch, linearised at the predicted state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement<'a, T> {
    /// h = ∂h/∂x⁻: pairs of a state's index and the derivative by it; what is not named is zero.
    pub row: &'a [(usize, T)],
    /// ε = z − h(x⁻), at the prediction for all measurements of the epoch.
    pub innovation: T,
    /// R, in the measurement's unit squared.
    pub variance: T,
}

impl<'a, T: Scalar> Measurement<'a, T> {
    /// A measurement from a row of `kestirim_kalman`.
    pub const fn new<const K: usize>(row: &'a SparseRow<T, K>, innovation: T, variance: T) -> Self {
        Self { row: row.entries(), innovation, variance }
    }

    /// ε − h·(x − x⁻): what is left of the innovation at another mean. Indices beyond the state count
    /// as zeros: the update has refused them before.
    #[inline(always)]
    pub(crate) fn left<const N: usize>(&self, prior: &Gaussian<T, N>, now: &Gaussian<T, N>) -> T {
        let (before, after) = (prior.mean.as_array(), now.mean.as_array());
        let mut sum = T::accumulator();
        for &(index, value) in self.row {
            if let (Some(&before), Some(&after)) = (before.get(index), after.get(index)) {
                sum = T::mac(sum, value, after - before);
            }
        }
        self.innovation - T::finish(sum)
    }

    /// h P hᵀ.
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
