//! A bias common to all ranges, estimated together with the position.

use crate::symmetric::{Factors, NormalEquations};
use kestirim_scalar::Scalar;

/// The last row of the normal equations, in which each range has the coefficient 1: hᵀ x + s bias = g. It is
/// eliminated before the position is solved for, so that the position's equations have the same size with and
/// without a bias.
pub(crate) struct CommonBias<T, const D: usize> {
    along: [T; D],
    weight: T,
    right: T,
}

impl<T: Scalar, const D: usize> CommonBias<T, D> {
    pub(crate) fn new() -> Self {
        Self { along: [T::ZERO; D], weight: T::ZERO, right: T::ZERO }
    }

    /// Adds the equation `row · x + bias = value` with this weight.
    pub(crate) fn add(&mut self, row: &[T; D], value: T, weight: T) {
        for axis in 0..D {
            self.along[axis] += weight * row[axis];
        }
        self.weight += weight;
        self.right += weight * value;
    }

    /// Subtracts the eliminated bias from the position's equations: A − h hᵀ / s and b − h g / s.
    pub(crate) fn eliminate_from(&self, equations: &mut NormalEquations<T, D>) {
        let divisor = self.weight.divisor();
        for i in 0..D {
            let share = self.along[i].divided_by(divisor);
            for j in 0..=i {
                equations.a[i][j] -= share * self.along[j];
            }
            equations.b[i] -= share * self.right;
        }
    }

    /// The bias that belongs to this position.
    pub(crate) fn solve(&self, position: &[T; D]) -> T {
        (self.right - T::dot(&self.along, position)) / self.weight
    }

    /// The variance of the bias for weights that are reciprocal variances: (1 + hᵀ A⁻¹ h / s) / s.
    pub(crate) fn variance(&self, factors: &Factors<T, D>) -> T {
        let through = factors.solve(&self.along);
        (T::ONE + T::dot(&self.along, &through) / self.weight) / self.weight
    }
}
