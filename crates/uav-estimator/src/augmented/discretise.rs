//! Discretisation of the augmented model that skips the zeros of its matrices.
//!
//! The exact step of `kestirim-observer-design` computes with 106 bits and dense matrices. With jittering intervals,
//! a step is computed per sample, and a filter that rounds every product does not need the last digits of a double.

use kestirim_scalar::Columns;
use nalgebra::SMatrix;

/// Number of terms of the series that matter for the noise, where ‖A h‖ is at most 1.
const TERMS: u32 = 20;
/// Largest number of halvings of the interval: an interval of 2⁶⁴ parts leaves nothing finite.
const MOST_HALVINGS: u32 = 64;

/// The flow of ẋ = A x + w, where the first K states drive the first four and all others only themselves: the
/// transition, its integral, and the covariance of the noise.
pub(super) struct Flow<const N: usize, const K: usize> {
    pub(super) transition: SMatrix<f64, N, N>,
    pub(super) integral: SMatrix<f64, N, N>,
    pub(super) noise: SMatrix<f64, N, N>,
}

impl<const N: usize, const K: usize> Flow<N, K> {
    /// The flow over a positive `interval` (s); `None` if the result is not finite.
    pub(super) fn new(
        a: &SMatrix<f64, N, N>,
        density: &SMatrix<f64, N, N>,
        interval: f64,
    ) -> Option<Self> {
        let columns = a.as_columns();
        let mut norm = 0.0_f64;
        for row in 0..N {
            norm = norm.max(columns.iter().map(|column| column[row].abs()).sum());
        }
        let mut part = interval;
        let mut halvings = 0;
        while norm * part > 0.5 {
            if halvings == MOST_HALVINGS {
                return None;
            }
            halvings += 1;
            part *= 0.5;
        }
        let mut flow = Self::short(a, density, part);
        for _ in 0..halvings {
            flow = Self {
                transition: flow.transition * flow.transition,
                integral: flow.integral + flow.transition * flow.integral,
                noise: flow.noise + flow.transition * flow.noise * flow.transition.transpose(),
            };
        }
        let all = flow.transition.iter().chain(&flow.integral).chain(&flow.noise);
        all.copied().all(f64::is_finite).then_some(flow)
    }

    fn short(a: &SMatrix<f64, N, N>, density: &SMatrix<f64, N, N>, interval: f64) -> Self {
        // h^k A^(k−1) / k!, and h^k/k! times the k-th derivative of the noise covariance, by P ← A P + P Aᵀ.
        let mut term = SMatrix::<f64, N, N>::identity() * interval;
        let mut noise_term = density * interval;
        let (mut integral, mut noise) = (term, noise_term);
        for k in 2..TERMS {
            let factor = interval / f64::from(k);
            term = times::<N, K>(a, &term) * factor;
            let half = times::<N, K>(a, &noise_term);
            noise_term = (half + half.transpose()) * factor;
            integral += term;
            noise += noise_term;
        }
        let transition = SMatrix::identity() + times::<N, K>(a, &integral);
        Self { transition, integral, noise }
    }
}

/// The product A X, for an A that beyond its first four rows and K columns has only a diagonal.
fn times<const N: usize, const K: usize>(
    a: &SMatrix<f64, N, N>,
    x: &SMatrix<f64, N, N>,
) -> SMatrix<f64, N, N> {
    let mut product = SMatrix::<f64, N, N>::zeros();
    let a = a.as_columns();
    for (product, x) in product.as_columns_mut().iter_mut().zip(x.as_columns()) {
        for row in 0..N {
            product[row] =
                if row < 4 { (0..K).map(|k| a[k][row] * x[k]).sum() } else { a[row][row] * x[row] };
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_observer_design::{discrete_noise, zero_order_hold};

    #[test]
    fn is_the_exact_step() {
        let mut a = SMatrix::<f64, 7, 7>::zeros();
        for row in 0..4 {
            for column in 0..6 {
                a[(row, column)] = (((3 * row + 5 * column) % 7) as f64 - 3.0) * 4.0;
            }
        }
        a[(4, 4)] = -2.0;
        a[(5, 5)] = 0.0;
        a[(6, 6)] = -0.1;
        let root = SMatrix::<f64, 7, 7>::from_fn(|i, j| ((i * 5 + j * 3) % 4) as f64 - 1.0);
        let density = root * root.transpose();
        for interval in [1e-3, 0.02, 0.3] {
            let flow = Flow::<7, 6>::new(&a, &density, interval).unwrap();
            let exact = zero_order_hold(&a, &SMatrix::<f64, 7, 7>::identity(), interval).unwrap();
            let noise = discrete_noise(&a, &density, interval).unwrap();
            let near = |ours: &SMatrix<f64, 7, 7>, exact: &SMatrix<f64, 7, 7>| {
                assert!((ours - exact).norm() < 1e-12 * exact.norm(), "{interval}");
            };
            near(&flow.transition, &exact.a);
            near(&flow.integral, &exact.b);
            near(&flow.noise, &noise);
        }
        assert!(Flow::<7, 6>::new(&a, &density, 1e9).is_none());
    }
}
