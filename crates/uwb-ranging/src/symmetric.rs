//! Systems of up to four normal equations.

use kestirim_scalar::Scalar;

/// The most unknowns: three coordinates and a common bias.
pub(crate) const MOST: usize = 4;

/// Normal equations A x = b of up to [`MOST`] unknowns; only the lower triangle of A is read.
#[derive(Clone, Copy)]
pub(crate) struct NormalEquations<T> {
    pub(crate) a: [[T; MOST]; MOST],
    pub(crate) b: [T; MOST],
}

impl<T: Scalar> NormalEquations<T> {
    /// Equations of so many unknowns. The others are said to be zero, with a weight of 1: all loops have
    /// the same length.
    pub(crate) fn new(unknowns: usize) -> Self {
        let mut a = [[T::ZERO; MOST]; MOST];
        for (index, row) in a.iter_mut().enumerate().skip(unknowns) {
            if let Some(diagonal) = row.get_mut(index) {
                *diagonal = T::ONE;
            }
        }
        Self { a, b: [T::ZERO; MOST] }
    }

    /// Adds the equation `row · x = value` with this weight.
    pub(crate) fn add(&mut self, row: &[T; MOST], value: T, weight: T) {
        for i in 0..MOST {
            let weighed = weight * row[i];
            for j in 0..=i {
                self.a[i][j] += weighed * row[j];
            }
            self.b[i] += weighed * value;
        }
    }

    /// A = L D Lᵀ, unless a pivot is smaller than `least` of the largest diagonal element: then A is as
    /// good as singular.
    pub(crate) fn factorised(&self, least: T) -> Option<Factors<T>> {
        let (mut l, mut d) = (self.a, [T::ONE; MOST]);
        let largest = (0..MOST).fold(T::ZERO, |most, i| most.max(self.a[i][i]));
        let threshold = largest * least;
        for i in 0..MOST {
            for j in 0..i {
                let mut sum = self.a[i][j];
                for k in 0..j {
                    sum -= l[i][k] * d[k] * l[j][k];
                }
                l[i][j] = sum / d[j];
            }
            let mut pivot = self.a[i][i];
            for k in 0..i {
                pivot -= l[i][k] * l[i][k] * d[k];
            }
            // A NaN is not above it either.
            if !(pivot > threshold && pivot.is_finite()) {
                return None;
            }
            d[i] = pivot;
        }
        Some(Factors { l, d })
    }
}

/// L D Lᵀ.
pub(crate) struct Factors<T> {
    l: [[T; MOST]; MOST],
    d: [T; MOST],
}

impl<T: Scalar> Factors<T> {
    /// A⁻¹ b.
    pub(crate) fn solve(&self, b: &[T; MOST]) -> [T; MOST] {
        let mut x = [T::ZERO; MOST];
        for i in 0..MOST {
            let mut sum = b[i];
            for k in 0..i {
                sum -= self.l[i][k] * x[k];
            }
            x[i] = sum;
        }
        for i in (0..MOST).rev() {
            let mut sum = x[i] / self.d[i];
            for k in i + 1..MOST {
                sum -= self.l[k][i] * x[k];
            }
            x[i] = sum;
        }
        x
    }

    /// A⁻¹.
    pub(crate) fn inverse(&self) -> [[T; MOST]; MOST] {
        let mut inverse = [[T::ZERO; MOST]; MOST];
        for i in 0..MOST {
            let mut unit = [T::ZERO; MOST];
            unit[i] = T::ONE;
            inverse[i] = self.solve(&unit);
        }
        inverse
    }
}
