//! Division by a reciprocal from Newton's iteration, for a single quotient or for many.

use super::Fixed;
use super::wide::unsigned_product;

/// A fixed-point divisor as reciprocal, shift and sign.
///
/// A plain reciprocal in the same format would overflow for small divisors and lose digits for large
/// ones; this one keeps 32 bits for every divisor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedDivisor<const FRAC: u32> {
    /// 2⁶³ / (the divisor's magnitude, shifted left until its top bit is set).
    reciprocal: u32,
    /// Number of bits by which a product with the reciprocal is shifted right; 0 marks a divisor of zero.
    shift: u32,
    negative: bool,
}

impl<const FRAC: u32> FixedDivisor<FRAC> {
    #[inline]
    pub(super) fn new(divisor: Fixed<FRAC>) -> Self {
        let magnitude = divisor.to_bits().unsigned_abs();
        if magnitude == 0 {
            return Self { reciprocal: 0, shift: 0, negative: false };
        }
        let zeros = magnitude.leading_zeros();
        Self {
            reciprocal: reciprocal(magnitude << zeros),
            // At least 2, since FRAC ≤ 30 and zeros ≤ 31.
            shift: 63 - FRAC - zeros,
            negative: divisor.to_bits() < 0,
        }
    }

    /// dividend / divisor, within one and a half units in the last place.
    #[inline]
    pub(super) fn divide(self, dividend: Fixed<FRAC>) -> Fixed<FRAC> {
        let Some(half) = self.shift.checked_sub(1) else { return over_zero(dividend) };
        let product = unsigned_product(dividend.to_bits().unsigned_abs(), self.reciprocal);
        with_sign((shifted(product, half) + 1) >> 1, (dividend.to_bits() < 0) != self.negative)
    }
}

impl<const FRAC: u32> Fixed<FRAC> {
    /// self / divisor, rounded to nearest, halves away from zero.
    #[inline]
    pub(super) fn quotient(self, divisor: Self) -> Self {
        let prepared = FixedDivisor::new(divisor);
        if prepared.shift == 0 {
            return over_zero(self);
        }
        let negative = (self.0 < 0) != prepared.negative;
        let (dividend, divisor) = (self.0.unsigned_abs(), divisor.0.unsigned_abs());
        let estimate = shifted(unsigned_product(dividend, prepared.reciprocal), prepared.shift);
        let Ok(mut quotient) = u32::try_from(estimate) else {
            return with_sign(estimate, negative);
        };
        // The estimate is never too large and at most three too small.
        let mut rest =
            (u64::from(dividend) << FRAC).wrapping_sub(unsigned_product(quotient, divisor));
        while rest >= u64::from(divisor) {
            rest -= u64::from(divisor);
            quotient = quotient.saturating_add(1);
        }
        with_sign(u64::from(quotient) + u64::from(2 * rest >= u64::from(divisor)), negative)
    }
}

/// value >> by, for 1 ≤ by ≤ 63. By words: shifts of 64 bits by a variable are function calls on small targets.
#[inline(always)]
fn shifted(value: u64, by: u32) -> u64 {
    let (high, low) = ((value >> 32) as u32, value as u32);
    if by < 32 {
        let lower = high.wrapping_shl(32 - by) | low.wrapping_shr(by);
        (u64::from(high.wrapping_shr(by)) << 32) | u64::from(lower)
    } else {
        u64::from(high.wrapping_shr(by - 32))
    }
}

/// The quotient of a division by zero: the rail of the dividend's sign, and the lower one for 0/0.
fn over_zero<const FRAC: u32>(dividend: Fixed<FRAC>) -> Fixed<FRAC> {
    Fixed(if dividend.to_bits() > 0 { i32::MAX } else { i32::MIN })
}

#[inline(always)]
fn with_sign<const FRAC: u32>(magnitude: u64, negative: bool) -> Fixed<FRAC> {
    Fixed(match (i32::try_from(magnitude), negative) {
        (Ok(magnitude), false) => magnitude,
        (Ok(magnitude), true) => -magnitude,
        (Err(_), false) => i32::MAX,
        (Err(_), true) => i32::MIN,
    })
}

/// 2⁶³/m for 2³¹ ≤ m < 2³², never too large and at most two units too small.
///
/// A parabola and three Newton steps r ← r + r·(1 − m·r), each with only the bits it needs: a quarter of
/// the instructions of a 64-bit division on ARMv6-M.
#[inline(always)]
pub(super) fn reciprocal(m: u32) -> u32 {
    let short = m >> 16;
    // 4.2424 − 5.8182·m + 2.5859·m², within 1 %; 14 fractional bits.
    let r = 69_508 - (((95_325 - ((42_367 * short) >> 16)) * short) >> 16);
    // Within 1.4·10⁻⁴; 15 fractional bits.
    let error = (1 << 30) - (short * r) as i32;
    let r = (2 * r).wrapping_add_signed((r as i32 * (error >> 13)) >> 16);
    // Within 2.5·10⁻⁸; 31 fractional bits.
    let error = (1_u32 << 31).wrapping_sub(short * r + (((m & 0xFFFF) * r) >> 16)) as i32;
    let r = (r << 16).wrapping_add_signed((r as i32 * (error >> 4)) >> 11);
    // All bits.
    let error = ((1_u64 << 63).wrapping_sub(unsigned_product(m, r)) as i64 >> 24) as i32;
    r.wrapping_add_signed(((r >> 16) as i32 * error) >> 23)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(m: u32) {
        let exact = (1_u64 << 63) / u64::from(m);
        let ours = u64::from(reciprocal(m));
        assert!(ours <= exact && exact - ours <= 2, "1/{m}: {ours}, not {exact}");
    }

    #[test]
    fn words_are_shifted_like_a_whole() {
        for by in 1..=63 {
            for bit in 0..64 {
                let values =
                    [1 << bit, (1 << bit) - 1, u64::MAX >> bit, 0x5555_5555_5555_5555 << bit];
                for value in values {
                    assert_eq!(shifted(value, by), value >> by, "{value} by {by}");
                }
            }
        }
    }

    #[test]
    fn the_reciprocal_is_never_above_and_hardly_below() {
        (0..1 << 31).step_by(1019).for_each(|k| check((1 << 31) + k));
        (0..1000).for_each(|k| check(u32::MAX - k));
    }

    #[test]
    #[ignore = "two billion divisions: cargo test --release -p kestirim-scalar -- --ignored"]
    fn the_reciprocal_is_never_above_and_hardly_below_for_any_mantissa() {
        ((1 << 31)..=u32::MAX).for_each(check);
    }
}
