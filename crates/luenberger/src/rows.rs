use crate::Error;
use crate::carried::{Carried, mac};
use crate::dense::Dense;
use crate::integers::{and_magnitudes, exponents, integers, scaled, shifts};
use kestirim_scalar::{Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// A matrix as integers, before conversion to a scalar type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct IntegerRows<const R: usize, const C: usize> {
    exponents: [i32; R],
    integers: [[i64; R]; C],
}

impl<const R: usize, const C: usize> IntegerRows<R, C> {
    pub(crate) const fn new(matrix: &Dense<R, C>) -> Self {
        let exponents = exponents(and_magnitudes([0.0; R], matrix));
        Self { exponents, integers: integers(matrix, &exponents) }
    }
}

/// A matrix whose products are rounded once per row; each row is scaled up by as many bits as the scalar type allows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub(crate) struct Rows<T: Scalar, const R: usize, const C: usize> {
    matrix: SMatrix<T, R, C>,
    shifts: SVector<u32, R>,
}

impl<T: Scalar, const R: usize, const C: usize> Rows<T, R, C> {
    pub(crate) fn new(design: &IntegerRows<R, C>) -> Result<Self, Error> {
        let shifts = shifts::<T, R>(&design.exponents)?;
        Ok(Self { matrix: scaled(&design.integers, &design.exponents, &shifts), shifts })
    }

    /// The state after adding matrix · vector, including the remainder of the last step.
    #[inline(always)]
    pub(crate) fn advanced(
        &self,
        state: &Carried<T, R>,
        vector: &SVector<T, C>,
    ) -> Result<Carried<T, R>, Error> {
        let mut sums = state.sums();
        mac(&mut sums, &self.matrix, vector);
        state.advanced(&sums, &self.shifts)
    }

    /// start + matrix · vector.
    #[inline(always)]
    pub(crate) fn added(&self, start: &SVector<T, R>, vector: &SVector<T, C>) -> SVector<T, R> {
        let mut sums = [T::accumulator(); R];
        mac(&mut sums, &self.matrix, vector);
        let mut result = *start;
        for (row, value) in result.as_array_mut().iter_mut().enumerate() {
            *value = value.advanced(sums[row], self.shifts.as_array()[row]).0;
        }
        result
    }
}
