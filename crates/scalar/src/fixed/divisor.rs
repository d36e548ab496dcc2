//! A division paid for once and used for many quotients.

use super::Fixed;

/// A fixed-point divisor as reciprocal mantissa, shift and sign.
///
/// A plain reciprocal in the same format overflows for small divisors and loses digits for large
/// ones; the mantissa keeps 32 bits whatever the size.
#[derive(Clone, Copy, Debug)]
pub struct FixedDivisor<const FRAC: u32> {
    /// 2⁶³ / (the divisor's magnitude, shifted until its top bit is set).
    mantissa: u32,
    /// How far it was shifted; 32 marks the divisor zero.
    shift: u32,
    negative: bool,
}

impl<const FRAC: u32> FixedDivisor<FRAC> {
    #[inline]
    pub(super) fn new(divisor: Fixed<FRAC>) -> Self {
        let magnitude = divisor.to_bits().unsigned_abs();
        let shift = magnitude.leading_zeros();
        // Zero has no top bit to shift into place: any mantissa will do.
        let normalised = magnitude.wrapping_shl(shift) | 1 << 31;
        let mantissa = (1_u64 << 63) / u64::from(normalised);
        Self {
            mantissa: u32::try_from(mantissa).unwrap_or(u32::MAX),
            shift,
            negative: divisor.to_bits() < 0,
        }
    }

    /// dividend / divisor, within one unit in the last place plus 2⁻³¹ of itself.
    #[inline]
    pub(super) fn divide(self, dividend: Fixed<FRAC>) -> Fixed<FRAC> {
        if self.shift == 32 {
            return dividend / Fixed(0);
        }
        let product = i64::from(dividend.to_bits()) * i64::from(self.mantissa);
        // At least 2 for FRAC ≤ 30, so that half of the last place exists.
        let shift = 63 - FRAC - self.shift;
        let quotient = ((product >> (shift - 1)) + 1) >> 1;
        Fixed::saturate(if self.negative { -quotient } else { quotient })
    }
}
