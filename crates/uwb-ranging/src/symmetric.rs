//! Systems of a few normal equations.

use kestirim_scalar::Scalar;

/// Pivots no larger than this share of the largest diagonal element make the system count as singular.
const LEAST_PIVOT: f64 = 1e-4;

/// Normal equations A x = b of M unknowns; only the lower triangle of A is read.
#[derive(Clone, Copy)]
pub(crate) struct NormalEquations<T, const M: usize> {
    pub(crate) a: [[T; M]; M],
    pub(crate) b: [T; M],
}

impl<T: Scalar, const M: usize> NormalEquations<T, M> {
    /// A system without equations.
    pub(crate) fn new() -> Self {
        Self { a: [[T::ZERO; M]; M], b: [T::ZERO; M] }
    }

    /// Adds the equation `row · x = value` with this weight.
    pub(crate) fn add(&mut self, row: &[T; M], value: T, weight: T) {
        for i in 0..M {
            let weighed = weight * row[i];
            for j in 0..=i {
                self.a[i][j] += weighed * row[j];
            }
            self.b[i] += weighed * value;
        }
    }

    /// The smallest pivot with which the equations still determine every unknown.
    pub(crate) fn least_pivot(&self) -> T {
        (0..M).fold(T::ZERO, |most, i| most.max(self.a[i][i])) * T::from_f64(LEAST_PIVOT)
    }

    /// The factors A = L D Lᵀ, or `None` if A is nearly singular.
    pub(crate) fn factorised(&self) -> Option<Factors<T, M>> {
        self.factorised_above(self.least_pivot())
    }

    /// The factors A = L D Lᵀ, or `None` if a pivot is not above `least`.
    pub(crate) fn factorised_above(&self, least: T) -> Option<Factors<T, M>> {
        let (mut l, mut d) = (self.a, [T::ONE; M]);
        for i in 0..M {
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
            // A NaN fails this comparison, too.
            if !(pivot > least && pivot.is_finite()) {
                return None;
            }
            d[i] = pivot;
        }
        Some(Factors { l, d })
    }
}

/// The factors of A = L D Lᵀ.
pub(crate) struct Factors<T, const M: usize> {
    l: [[T; M]; M],
    d: [T; M],
}

impl<T: Scalar, const M: usize> Factors<T, M> {
    /// The solution A⁻¹ b.
    pub(crate) fn solve(&self, b: &[T; M]) -> [T; M] {
        let mut x = [T::ZERO; M];
        for i in 0..M {
            let mut sum = b[i];
            for k in 0..i {
                sum -= self.l[i][k] * x[k];
            }
            x[i] = sum;
        }
        for i in (0..M).rev() {
            let mut sum = x[i] / self.d[i];
            for k in i + 1..M {
                sum -= self.l[k][i] * x[k];
            }
            x[i] = sum;
        }
        x
    }

    /// The inverse A⁻¹.
    pub(crate) fn inverse(&self) -> [[T; M]; M] {
        let mut inverse = [[T::ZERO; M]; M];
        for i in 0..M {
            let mut unit = [T::ZERO; M];
            unit[i] = T::ONE;
            inverse[i] = self.solve(&unit);
        }
        inverse
    }
}
