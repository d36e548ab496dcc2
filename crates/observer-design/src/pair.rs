//! A pair (A, C) conditioned for computation: dependent outputs are merged, and units are balanced.

use crate::Error;
use crate::extended::Extended;
use crate::number::{Number, Square, Times, extend, finite, norm};
use crate::orthonormal::{inner, length};
use kestirim_scalar::{Columns, Components};
use nalgebra::{Complex, SMatrix, SVector};

/// A balanced pair: with x = D x̃, where D holds powers of two, Ã = D⁻¹ A D and S = W C D. W has as many rows as C has
/// independent ones.
pub(crate) struct Pair<const N: usize> {
    /// Ã, the balanced dynamics.
    pub(crate) dynamics: Square<Extended, N>,
    /// S, the balanced outputs, in the first `rank` rows; zeros below.
    pub(crate) outputs: Square<Extended, N>,
    /// Number of independent outputs.
    pub(crate) rank: usize,
    scale: [Extended; N],
}

/// W, which combines the outputs to independent ones.
pub(crate) struct Merging<const N: usize, const P: usize>(SMatrix<Extended, P, N>);

/// Largest length of a column attributed to rounding, relative to the longest column.
const NEGLIGIBLE: f64 = 1e-13;

impl<const N: usize> Pair<N> {
    /// # Errors
    /// [`Error::NotFinite`].
    pub(crate) fn new<const P: usize>(
        a: &Square<f64, N>,
        c: &SMatrix<f64, P, N>,
    ) -> Result<(Self, Merging<N, P>), Error> {
        if !finite(a) || !finite(c) {
            return Err(Error::NotFinite);
        }
        let (outputs, rank, merging) = merge(c);
        let mut pair = Self { dynamics: extend(a), outputs, rank, scale: [Extended::from(1.0); N] };
        pair.balance();
        Ok((pair, merging))
    }

    /// Balances rows and columns (Osborne 1960), where the outputs count as part of the columns.
    fn balance(&mut self) {
        for _ in 0..50 {
            let mut settled = true;
            for state in 0..N {
                if let Some(factor) = self.evening(state) {
                    settled = false;
                    self.rescale(state, factor);
                }
            }
            if settled {
                return;
            }
        }
    }

    /// The power of two by which a state must be rescaled, if any.
    fn evening(&self, state: usize) -> Option<f64> {
        let size = |value: &Extended| value.to_f64().abs();
        let (driven, seen) =
            (self.dynamics.as_columns().get(state)?, self.outputs.as_columns().get(state)?);
        let driving = self.dynamics.as_columns().iter().filter_map(|column| column.get(state));
        let mut column: f64 = seen.iter().map(size).sum();
        let mut row = 0.0;
        for (index, (driven, driving)) in driven.iter().zip(driving).enumerate() {
            if index != state {
                column += size(driven);
                row += size(driving);
            }
        }
        // A state that nothing drives can be scaled freely: its effect is made as large as its own motion.
        if row == 0.0 {
            row = driven.get(state).map_or(0.0, size);
        }
        if column == 0.0 || row == 0.0 {
            return None;
        }
        let exponent = libm::round(libm::log2(row / column) / 2.0);
        let factor = libm::exp2(exponent);
        (exponent != 0.0 && factor.is_normal() && (1.0 / factor).is_normal()).then_some(factor)
    }

    fn rescale(&mut self, state: usize, factor: f64) {
        let (factor, reciprocal) = (Extended::from(factor), Extended::from(1.0 / factor));
        self.scale[state] *= factor;
        for index in 0..N {
            self.dynamics[(index, state)] *= factor;
            self.dynamics[(state, index)] *= reciprocal;
            self.outputs[(index, state)] *= factor;
        }
    }

    /// L of x⁺ = A x + L (y − C x) from L̃ of the balanced pair, whose columns beyond the rank are ignored.
    pub(crate) fn gain<const P: usize>(
        &self,
        gain: &Square<Extended, N>,
        Merging(merging): &Merging<N, P>,
    ) -> SMatrix<Extended, N, P> {
        self.gain_out(&gain.times(&merging.transpose()))
    }

    /// D⁻¹ M D: a matrix over the original states on the balanced scale.
    pub(crate) fn balanced(&self, matrix: &Square<Extended, N>) -> Square<Extended, N> {
        SMatrix::from_fn(|row, column| matrix[(row, column)] * self.scale[column] / self.scale[row])
    }

    /// C D: the rows of C on the balanced scale.
    pub(crate) fn scaled<const P: usize>(
        &self,
        outputs: &SMatrix<Extended, P, N>,
    ) -> SMatrix<Extended, P, N> {
        SMatrix::from_fn(|row, column| outputs[(row, column)] * self.scale[column])
    }

    /// D L̃: a gain on the original scale.
    pub(crate) fn gain_out<const P: usize>(
        &self,
        gain: &SMatrix<Extended, N, P>,
    ) -> SMatrix<Extended, N, P> {
        SMatrix::from_fn(|row, column| gain[(row, column)] * self.scale[row])
    }

    /// D⁻¹ P D⁻¹: a covariance on the balanced scale.
    pub(crate) fn covariance_in(&self, matrix: &Square<Extended, N>) -> Square<Extended, N> {
        SMatrix::from_fn(|row, column| {
            matrix[(row, column)] / (self.scale[row] * self.scale[column])
        })
    }

    /// D P̃ D: a covariance on the original scale.
    pub(crate) fn covariance_out(&self, matrix: &Square<Extended, N>) -> Square<Extended, N> {
        SMatrix::from_fn(|row, column| matrix[(row, column)] * self.scale[row] * self.scale[column])
    }

    /// D x̃: a vector of states on the original scale.
    pub(crate) fn unbalanced(
        &self,
        vector: &SVector<Complex<Extended>, N>,
    ) -> SVector<Complex<Extended>, N> {
        SVector::from_fn(|state, _| vector[state].scaled(self.scale[state]))
    }

    /// ỹ D⁻¹: a row over the states on the original scale.
    pub(crate) fn unbalanced_row(
        &self,
        row: &SVector<Complex<Extended>, N>,
    ) -> SVector<Complex<Extended>, N> {
        SVector::from_fn(|state, _| row[state].scaled(Extended::from(1.0) / self.scale[state]))
    }

    /// ‖S‖, the norm of the balanced outputs.
    pub(crate) fn outputs_norm(&self) -> f64 {
        norm(&self.outputs)
    }
}

/// Factors C = Q S with orthonormal columns Q, after every output was scaled to a magnitude of about 1.
fn merge<const N: usize, const P: usize>(
    c: &SMatrix<f64, P, N>,
) -> (Square<Extended, N>, usize, Merging<N, P>) {
    let mut weights = [Extended::from(0.0); P];
    let mut rest = extend(c);
    for row in 0..P {
        let size =
            c.as_columns().iter().fold(0.0, |largest: f64, column| largest.max(column[row].abs()));
        if size > 0.0 {
            weights[row] = Extended::from(libm::exp2(-libm::floor(libm::log2(size))));
        }
        for column in 0..N {
            rest[(row, column)] *= weights[row];
        }
    }
    let weighted = rest;
    let mut basis = SMatrix::<Extended, P, N>::zeros();
    let mut largest = 0.0;
    let mut rank = 0;
    for direction in basis.as_columns_mut().iter_mut().take(N) {
        let size = |column: &SVector<Extended, P>| length(column).to_f64();
        let columns = rest.as_columns().iter().map(|&column| SVector::from(column));
        let Some(pivot) = columns.max_by(|a, b| size(a).total_cmp(&size(b))) else { break };
        largest = f64::max(largest, size(&pivot));
        if size(&pivot) <= NEGLIGIBLE * largest {
            break;
        }
        let reciprocal = Extended::from(1.0) / length(&pivot);
        let unit = pivot.map(|value| value * reciprocal);
        *direction = *unit.as_array();
        rank += 1;
        for column in rest.as_columns_mut() {
            let vector = SVector::from(*column);
            *column = *(vector - unit * inner(&unit, &vector)).as_array();
        }
    }
    let outputs = basis.transpose().times(&weighted);
    for row in 0..P {
        for column in 0..N {
            basis[(row, column)] *= weights[row];
        }
    }
    (outputs, rank, Merging(basis))
}
