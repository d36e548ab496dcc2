//! Quotients of large integers as metres.

use kestirim_scalar::Scalar;

// Metres per tick as a reduced fraction: 299 792 458 / 63 897 600 000.
const METRES: i128 = 149_896_229;
const TICKS: i128 = 31_948_800_000;

/// The distance that light travels in `numerator / denominator` ticks (m), with an error of 2·10⁻⁷ of itself plus
/// 10⁻⁷ m, or the scalar's own rounding.
///
/// `|numerator|` up to 2⁹⁸ and `denominator` from 1 to 2⁹⁰. The quotient is found in two single-precision
/// steps with an exact remainder in between: 48 bits without a wide division and without double precision.
#[inline(never)]
pub(crate) fn light_distance<T: Scalar>(numerator: i128, denominator: i128) -> T {
    let numerator = numerator.wrapping_mul(METRES);
    let denominator = denominator.wrapping_mul(TICKS);
    let divisor = denominator as f32;
    let whole = (numerator as f32 / divisor) as i64;
    let rest = numerator.wrapping_sub(denominator.wrapping_mul(whole as i128));
    T::from_f32(whole as f32) + T::from_f32(rest as f32 / divisor)
}
