//! The normal equations of a fit's step.

use kestirim_scalar::Scalar;

use super::abreast::Seen;
use super::lanes::Lanes;
use super::sight::Row;

/// The normal equations of as many fits as there are lanes.
pub(super) struct Normal<T, const P: usize, const W: usize> {
    matrix: [[Lanes<T, W>; P]; P],
    vector: [Lanes<T, W>; P],
    used: usize,
}

impl<T: Scalar, const P: usize, const W: usize> Normal<T, P, W> {
    /// The equations of the prior alone: all parameters are 0 ± 1.
    #[inline(always)]
    pub(super) fn new(used: usize, parameters: &[Lanes<T, W>; P]) -> Self {
        let vector = parameters.map(|parameter| parameter.map(|it| -it));
        let mut matrix = [[Lanes::all(T::ZERO); P]; P];
        for (index, row) in matrix.iter_mut().enumerate() {
            row[index] = Lanes::all(T::ONE);
        }
        Self { matrix, vector, used }
    }

    #[inline(always)]
    pub(super) fn add(&mut self, row: &Row<T, P>, seen: &Seen<T, W>) {
        let used = self.used;
        let lines = self.matrix.iter_mut().zip(&mut self.vector).enumerate();
        for (index, (line, entry)) in lines.take(used) {
            let factor = seen.weighted * row.slopes[index];
            *entry += factor * seen.error;
            let factor = factor * seen.share;
            for (entry, other) in line.iter_mut().zip(&row.slopes).take(index + 1) {
                *entry += factor * *other;
            }
        }
    }

    /// Replaces the matrices with their Cholesky factors.
    #[inline(always)]
    pub(super) fn decompose(&mut self) {
        // Constant bounds, so that the compiler can prove the indices valid.
        for row in 0..P {
            if row >= self.used {
                break;
            }
            for column in 0..=row {
                let mut sum = self.matrix[row][column];
                for index in 0..column {
                    sum -= self.matrix[row][index] * self.matrix[column][index];
                }
                self.matrix[row][column] = if row == column {
                    // The prior alone makes it at least one.
                    sum.map(|it| it.max(T::HALF).sqrt())
                } else {
                    sum / self.matrix[column][column]
                };
            }
        }
    }

    /// Half the logarithms of the matrices' determinants, from their Cholesky factors.
    #[inline(always)]
    pub(super) fn log_determinant(&self) -> Lanes<T, W> {
        let mut sum = Lanes::all(T::ZERO);
        for (index, row) in self.matrix.iter().enumerate().take(self.used) {
            sum += row[index].map(T::ln);
        }
        sum
    }

    /// Solves for the change of the parameters with the Cholesky factors.
    #[inline(always)]
    pub(super) fn solve(&self) -> [Lanes<T, W>; P] {
        let mut change = self.vector;
        for row in 0..P {
            if row >= self.used {
                break;
            }
            let mut sum = change[row];
            for index in 0..row {
                sum -= self.matrix[row][index] * change[index];
            }
            change[row] = sum / self.matrix[row][row];
        }
        for row in (0..P).rev() {
            // Entries beyond the used ones are zero, and have no effect.
            let mut sum = change[row];
            for index in row + 1..P {
                sum -= self.matrix[index][row] * change[index];
            }
            change[row] = sum / self.matrix[row][row];
        }
        change
    }
}
