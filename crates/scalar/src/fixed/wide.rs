//! Products of 64 bits, and rounding back to 32.

use super::Fixed;

/// Whether to multiply by halves. ARMv6-M only multiplies 32 bits by 32 to 32; there, four products of halves cost two
/// thirds of the compiler's general 64-bit multiplication.
const BY_HALVES: bool = cfg!(all(target_arch = "arm", not(target_has_atomic = "32")));

/// The exact product a · b of signed numbers.
#[inline(always)]
pub(super) fn product(a: i32, b: i32) -> i64 {
    if BY_HALVES { product_by_halves(a, b) } else { i64::from(a) * i64::from(b) }
}

/// The exact product a · b of unsigned numbers.
#[inline(always)]
pub(super) fn unsigned_product(a: u32, b: u32) -> u64 {
    if BY_HALVES { unsigned_product_by_halves(a, b) } else { u64::from(a) * u64::from(b) }
}

/// The upper half of the product a · b of signed numbers.
#[inline(always)]
pub(super) fn high(a: i32, b: i32) -> i32 {
    (product(a, b) >> 32) as i32
}

/// The upper half of the product a · b of unsigned numbers.
#[inline(always)]
pub(super) fn unsigned_high(a: u32, b: u32) -> u32 {
    (unsigned_product(a, b) >> 32) as u32
}

/// The exact product by halves: Warren, Hacker's Delight (2nd ed.), 8–2. Compiled for size, all products share it.
#[cfg_attr(for_size, inline(never))]
#[cfg_attr(not(for_size), inline(always))]
fn product_by_halves(a: i32, b: i32) -> i64 {
    let (a_low, a_high) = (a & 0xFFFF, a >> 16);
    let (b_low, b_high) = (b & 0xFFFF, b >> 16);
    let lowest = (a_low as u32).wrapping_mul(b_low as u32) >> 16;
    let middle = a_high * b_low + lowest as i32;
    let crossed = a_low * b_high + (middle & 0xFFFF);
    let high = a_high * b_high + (middle >> 16) + (crossed >> 16);
    (i64::from(high) << 32) | i64::from(a.wrapping_mul(b) as u32)
}

/// The exact unsigned product, by way of the signed one: LLVM 22 recognises unsigned halves as a product, and calls
/// the general multiplication that they were meant to avoid.
#[inline(always)]
fn unsigned_product_by_halves(a: u32, b: u32) -> u64 {
    let signed = product_by_halves(a as i32, b as i32);
    let a_negative = (a as i32 >> 31) as u32;
    let b_negative = (b as i32 >> 31) as u32;
    // A number read as negative is too small by 2³².
    let high = ((signed >> 32) as u32).wrapping_add(a_negative & b).wrapping_add(b_negative & a);
    (u64::from(high) << 32) | u64::from(a.wrapping_mul(b))
}

impl<const FRAC: u32> Fixed<FRAC> {
    /// Converts a value with 2·FRAC fractional bits: rounded once, saturating.
    #[inline(always)]
    pub(super) fn narrowed(sum: i64) -> Self {
        // Where this wraps around, the result does not fit: its rail is that of the sum's sign.
        let rounded = sum.wrapping_add(1 << (FRAC - 1)) >> FRAC;
        let (low, high) = (rounded as i32, (rounded >> 32) as i32);
        // The result fits if the upper half is a sign extension.
        Self(if high == low >> 31 { low } else { (sum >> 63) as i32 ^ i32::MAX })
    }

    /// Converts a value with `from` fractional bits: rounded, saturating.
    #[inline(always)]
    pub(super) fn rescaled(value: i32, from: u32) -> Self {
        Self(match FRAC.checked_sub(from) {
            Some(up) => value.saturating_mul(1 << up),
            None => ((value >> (from - FRAC - 1)) + 1) >> 1,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn halves_make_the_same_product(a in any::<i32>(), b in any::<i32>()) {
            prop_assert_eq!(product_by_halves(a, b), i64::from(a) * i64::from(b));
            let (a, b) = (a as u32, b as u32);
            prop_assert_eq!(unsigned_product_by_halves(a, b), u64::from(a) * u64::from(b));
        }
    }

    fn check_narrowed<const FRAC: u32>(sum: i64) {
        let exact = (i128::from(sum) + (1 << (FRAC - 1))) >> FRAC;
        let nearest = exact.clamp(i128::from(i32::MIN), i128::from(i32::MAX));
        assert_eq!(i128::from(Fixed::<FRAC>::narrowed(sum).0), nearest, "{sum} in Q{FRAC}");
    }

    fn check_all_narrowed(sum: i64) {
        check_narrowed::<1>(sum);
        check_narrowed::<16>(sum);
        check_narrowed::<20>(sum);
        check_narrowed::<24>(sum);
        check_narrowed::<30>(sum);
    }

    proptest! {
        #[test]
        fn sums_are_rounded_once(sum in any::<i64>(), down in 0_u32..63) {
            check_all_narrowed(sum >> down);
        }
    }

    #[test]
    fn sums_are_rounded_once_at_the_edges() {
        for bit in 0..63 {
            for off in -2..=2 {
                check_all_narrowed((1_i64 << bit) + off);
                check_all_narrowed((-1_i64 << bit) - off);
            }
        }
        for off in 0..3 {
            check_all_narrowed(i64::MAX - off);
            check_all_narrowed(i64::MIN + off);
        }
        for frac in [1, 16, 20, 24, 30] {
            // Half a unit around both rails.
            for rail in [i64::from(i32::MAX), i64::from(i32::MIN)] {
                for off in -2..=2 {
                    let half = 1_i64 << (frac - 1);
                    check_all_narrowed((rail << frac) + half + off);
                    check_all_narrowed((rail << frac) - half + off);
                }
            }
        }
    }

    #[test]
    fn halves_make_the_same_product_at_the_edges() {
        for a in [i32::MIN, i32::MIN + 1, -65_536, -1, 0, 1, 65_535, 65_536, i32::MAX] {
            for b in [i32::MIN, -65_537, -1, 0, 1, 65_535, i32::MAX] {
                assert_eq!(product_by_halves(a, b), i64::from(a) * i64::from(b));
                let (a, b) = (a as u32, b as u32);
                assert_eq!(unsigned_product_by_halves(a, b), u64::from(a) * u64::from(b));
            }
        }
    }
}
