use crate::Error;
use crate::carried::{Carried, mac};
use crate::dense::Dense;
use crate::integers::{and_magnitudes, exponents, integers, scaled, shifts};
use kestirim_scalar::{Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// The coefficients of an [`Increment`] as integers, before conversion to a scalar type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct IntegerIncrement<const N: usize, const M: usize, const P: usize> {
    pub(crate) exponents: [i32; N],
    state: [[i64; N]; N],
    input: [[i64; N]; M],
    output: [[i64; N]; P],
}

impl<const N: usize, const M: usize, const P: usize> IntegerIncrement<N, M, P> {
    /// The coefficients from blocks whose rows are summed together.
    pub(crate) const fn new(
        state: &Dense<N, N>,
        input: &Dense<N, M>,
        output: &Dense<N, P>,
    ) -> Self {
        let sums = and_magnitudes(and_magnitudes(and_magnitudes([0.0; N], state), input), output);
        Self::with(exponents(sums), state, input, output)
    }

    /// The coefficients from blocks, with given exponents of the sums that they are part of.
    pub(crate) const fn with(
        exponents: [i32; N],
        state: &Dense<N, N>,
        input: &Dense<N, M>,
        output: &Dense<N, P>,
    ) -> Self {
        Self {
            exponents,
            state: integers(state, &exponents),
            input: integers(input, &exponents),
            output: integers(output, &exponents),
        }
    }
}

/// Increment of a state in one step: N × N, N × M and N × P blocks that multiply state, inputs and outputs. Row i is
/// scaled up by 2 to the power of `shifts[i]`.
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
pub(crate) struct Increment<T: Scalar, const N: usize, const M: usize, const P: usize> {
    state: SMatrix<T, N, N>,
    input: SMatrix<T, N, M>,
    output: SMatrix<T, N, P>,
    pub(crate) shifts: SVector<u32, N>,
}

impl<T: Scalar, const N: usize, const M: usize, const P: usize> Increment<T, N, M, P> {
    #[inline]
    pub(crate) fn new(design: &IntegerIncrement<N, M, P>) -> Result<Self, Error> {
        let exponents = &design.exponents;
        let shifts = shifts::<T, N>(exponents)?;
        Ok(Self {
            state: scaled(&design.state, exponents, &shifts),
            input: scaled(&design.input, exponents, &shifts),
            output: scaled(&design.output, exponents, &shifts),
            shifts,
        })
    }

    /// The sums of a step from this state with these inputs, including the remainder of the last step.
    #[inline(always)]
    pub(crate) fn driven(
        &self,
        state: &Carried<T, N>,
        input: &SVector<T, M>,
    ) -> [T::Accumulator; N] {
        let mut sums = state.sums();
        mac(&mut sums, &self.state, &state.value);
        mac(&mut sums, &self.input, input);
        sums
    }

    /// Adds the contribution of the outputs, or of their innovation, to the sums.
    #[inline(always)]
    pub(crate) fn and_output(&self, sums: &mut [T::Accumulator; N], output: &SVector<T, P>) {
        mac(sums, &self.output, output);
    }

    /// The state after a complete step.
    #[inline(always)]
    pub(crate) fn advanced(
        &self,
        state: &Carried<T, N>,
        input: &SVector<T, M>,
        output: &SVector<T, P>,
    ) -> Result<Carried<T, N>, Error> {
        if !(T::all_finite(input.as_array()) && T::all_finite(output.as_array())) {
            return Err(Error::NotFinite);
        }
        let mut sums = self.driven(state, input);
        self.and_output(&mut sums, output);
        state.advanced(&sums, &self.shifts)
    }
}
