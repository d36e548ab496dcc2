//! Division by a reciprocal: Newton's iteration on the normalised divisor, no hardware divider.

use super::Fixed;
use super::wide::{unsigned_high, unsigned_product};

/// A fixed-point divisor prepared for several quotients: the reciprocal of its mantissa, and a shift.
#[derive(Clone, Copy, Debug)]
pub struct Divisor {
    /// 2⁶³ / m for the divisor's magnitude m · 2^-leading zeros, 2³¹ ≤ m < 2³².
    reciprocal: u32,
    /// Takes the product with a dividend to the quotient; 0 marks a divisor of zero, else 2 to 62.
    shift: u32,
    negative: bool,
}

impl<const FRAC: u32> Fixed<FRAC> {
    #[inline]
    pub(super) fn prepared(self) -> Divisor {
        let magnitude = self.0.unsigned_abs();
        if magnitude == 0 {
            return Divisor { reciprocal: 0, shift: 0, negative: false };
        }
        let zeros = magnitude.leading_zeros();
        Divisor {
            reciprocal: reciprocal(magnitude << zeros),
            shift: 63 - FRAC - zeros,
            negative: self.0 < 0,
        }
    }

    /// The quotient, within one and a half units in the last place of a result below 2³⁰ units.
    #[inline]
    pub(super) fn over(self, divisor: Divisor) -> Self {
        if divisor.shift == 0 {
            return self.over_zero();
        }
        let product = unsigned_product(self.0.unsigned_abs(), divisor.reciprocal);
        let rounded = ((product >> (divisor.shift - 1)) + 1) >> 1;
        Self::with_sign(rounded, (self.0 < 0) != divisor.negative)
    }

    /// The quotient, correctly rounded.
    #[inline]
    pub(super) fn quotient(self, other: Self) -> Self {
        let divisor = other.prepared();
        if divisor.shift == 0 {
            return self.over_zero();
        }
        let negative = (self.0 < 0) != divisor.negative;
        let (magnitude, other) = (self.0.unsigned_abs(), other.0.unsigned_abs());
        let estimate = unsigned_product(magnitude, divisor.reciprocal) >> divisor.shift;
        let Ok(mut quotient) = u32::try_from(estimate) else {
            return Self::with_sign(estimate, negative);
        };
        // The estimate is never too large and at most three too small.
        let mut rest =
            (u64::from(magnitude) << FRAC).wrapping_sub(unsigned_product(quotient, other));
        while rest >= u64::from(other) {
            rest -= u64::from(other);
            quotient = quotient.saturating_add(1);
        }
        let rounded = quotient.saturating_add(u32::from(2 * rest >= u64::from(other)));
        Self::with_sign(u64::from(rounded), negative)
    }

    #[inline]
    const fn over_zero(self) -> Self {
        if self.0 > 0 { Self::MAX } else { Self::MIN }
    }

    #[inline]
    const fn with_sign(magnitude: u64, negative: bool) -> Self {
        if magnitude > i32::MAX as u64 {
            return if negative { Self::MIN } else { Self::MAX };
        }
        let magnitude = magnitude as i32;
        Self(if negative { -magnitude } else { magnitude })
    }
}

/// 2⁶³ / `m` for 2³¹ ≤ `m` < 2³², not above it and at most three below.
///
/// With d = m / 2³² in ½..1, r approaches 1/d as r + r·(1 − d·r), whose relative error is the
/// square of r's. The first steps have so few good bits that products of 32 bits hold them.
#[inline]
pub(super) fn reciprocal(m: u32) -> u32 {
    let short = m >> 16;
    // 4.2424 − 5.8182 d + 2.5859 d², the best parabola (1.0 %), with 14 fractional bits.
    let r = 69_508 - ((95_325 - ((42_367 * short) >> 16)) * short >> 16);
    // … with 15 (1.6e-4): what the first 16 bits of d can say.
    let error = (1 << 30) - (short * r) as i32;
    let r = (2 * r).wrapping_add_signed((r as i32 * (error >> 13)) >> 16);
    r
}
