//! Coefficients between double precision and a scalar type: integers with one exponent per row, which a
//! target converts without double-precision arithmetic.

use crate::Error;
use crate::dense::Dense;
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// Bits of a coefficient: an entry is its integer · 2^(exponent of its row − 62).
const BITS: i32 = 62;
/// Smallest exponent of a row: smaller rows keep fewer bits, which fixed point could not represent anyway.
const LEAST: i32 = -28;
/// Largest exponent of a row: no gain exceeds 2¹²⁰.
const MOST: i32 = 120;
/// Exponent that marks a row with an entry that is not finite.
const NOT_FINITE: i32 = i32::MAX;

/// Adds the magnitudes of each row of a block to `sums`.
pub(crate) const fn and_magnitudes<const R: usize, const C: usize>(
    mut sums: [f64; R],
    block: &Dense<R, C>,
) -> [f64; R] {
    let mut column = 0;
    while column < C {
        let mut row = 0;
        while row < R {
            sums[row] += block[column][row].abs();
            row += 1;
        }
        column += 1;
    }
    sums
}

/// The exponent, for each row, of the smallest power of two clearly above the sum of its magnitudes.
pub(crate) const fn exponents<const R: usize>(sums: [f64; R]) -> [i32; R] {
    let mut exponents = [0; R];
    let mut row = 0;
    while row < R {
        // The margin keeps rounding of the coefficients from carrying the sum over the power.
        let biased = ((sums[row] * (1.0 + 1e-6)).to_bits() >> 52) & 0x7FF;
        let exponent = biased as i32 - 1022;
        exponents[row] = if biased == 0x7FF {
            NOT_FINITE
        } else if exponent < LEAST {
            LEAST
        } else {
            exponent
        };
        row += 1;
    }
    exponents
}

/// The larger of the two exponents for each row.
pub(crate) const fn larger<const R: usize>(a: [i32; R], b: [i32; R]) -> [i32; R] {
    let mut larger = a;
    let mut row = 0;
    while row < R {
        if b[row] > a[row] {
            larger[row] = b[row];
        }
        row += 1;
    }
    larger
}

/// A block as integers, given the exponents of its rows.
pub(crate) const fn integers<const R: usize, const C: usize>(
    block: &Dense<R, C>,
    exponents: &[i32; R],
) -> [[i64; R]; C] {
    let mut integers = [[0; R]; C];
    let mut row = 0;
    while row < R {
        if exponents[row] != NOT_FINITE {
            let scale = f64::from_bits(((1023 + BITS - exponents[row]) as u64) << 52);
            let mut column = 0;
            while column < C {
                integers[column][row] = (block[column][row] * scale) as i64;
                column += 1;
            }
        }
        row += 1;
    }
    integers
}

/// The number of bits by which each row is scaled up in this scalar type.
pub(crate) fn shifts<T: Scalar, const R: usize>(
    exponents: &[i32; R],
) -> Result<SVector<u32, R>, Error> {
    let mut shifts = [0; R];
    for (shift, &exponent) in shifts.iter_mut().zip(exponents) {
        *shift = match exponent {
            NOT_FINITE => return Err(Error::NotFinite),
            ..=MOST => T::headroom(exponent).ok_or(Error::TooLarge)?,
            _ => return Err(Error::TooLarge),
        };
    }
    Ok(SVector::from(shifts))
}

/// A block in this scalar type, with its rows scaled up.
pub(crate) fn scaled<T: Scalar, const R: usize, const C: usize>(
    integers: &[[i64; R]; C],
    exponents: &[i32; R],
    shifts: &SVector<u32, R>,
) -> SMatrix<T, R, C> {
    let mut block = SMatrix::<T, R, C>::from([[T::ZERO; R]; C]);
    for (scaled, integers) in block.as_columns_mut().iter_mut().zip(integers) {
        let scales = exponents.iter().zip(shifts.as_array());
        for ((scaled, &integer), (&exponent, &shift)) in scaled.iter_mut().zip(integers).zip(scales)
        {
            let exponent = exponent - BITS + shift as i32;
            // Converted in two halves, as a coefficient has more bits than an `i32`.
            let (high, low) = ((integer >> 31) as i32, (integer & 0x7FFF_FFFF) as i32);
            *scaled = T::from_binary(high, exponent + 31) + T::from_binary(low, exponent);
        }
    }
    block
}
