use crate::Error;
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// A state with the rounding remainder of its last step, so that steps far below the resolution add up.
///
/// At 1 kHz a slow mode moves by a thousandth of its distance per step; rounded away, it would stop at a
/// wrong place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize, T::Accumulator: serde::Serialize",
        deserialize = "T: serde::Deserialize<'de>, T::Accumulator: serde::Deserialize<'de>"
    ))
)]
pub(crate) struct Carried<T: Scalar, const N: usize> {
    pub(crate) value: SVector<T, N>,
    rest: SVector<T::Accumulator, N>,
}

#[cfg(feature = "defmt")]
impl<T: Scalar + defmt::Format, const N: usize> defmt::Format for Carried<T, N> {
    fn format(&self, formatter: defmt::Formatter<'_>) {
        self.value.format(formatter);
    }
}

impl<T: Scalar, const N: usize> Carried<T, N> {
    pub(crate) fn new(value: &SVector<T, N>) -> Result<Self, Error> {
        if !T::all_finite(value.as_array()) {
            return Err(Error::NotFinite);
        }
        Ok(Self { value: *value, rest: SMatrix::from([[T::accumulator(); N]; 1]) })
    }

    /// The sums with which a step begins: the remainders of the last one.
    #[inline(always)]
    pub(crate) fn sums(&self) -> [T::Accumulator; N] {
        *self.rest.as_array()
    }

    /// The state after adding these sums, if it stays finite.
    #[inline(always)]
    pub(crate) fn advanced(
        &self,
        sums: &[T::Accumulator; N],
        shifts: &SVector<u32, N>,
    ) -> Result<Self, Error> {
        let mut next = *self;
        let (value, rest) = (next.value.as_array_mut(), next.rest.as_array_mut());
        for i in 0..N {
            (value[i], rest[i]) = value[i].advanced(sums[i], shifts.as_array()[i]);
        }
        if T::all_finite(value) { Ok(next) } else { Err(Error::NotFinite) }
    }
}

/// `sums += block · vector`.
#[inline(always)]
pub(crate) fn mac<T: Scalar, const R: usize, const C: usize>(
    sums: &mut [T::Accumulator; R],
    block: &SMatrix<T, R, C>,
    vector: &SVector<T, C>,
) {
    for column in 0..C {
        for row in 0..R {
            let (a, b) = (block.as_columns()[column][row], vector.as_array()[column]);
            sums[row] = T::mac_within(sums[row], a, b);
        }
    }
}
