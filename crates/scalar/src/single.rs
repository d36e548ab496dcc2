//! Single-precision functions that never use double precision.

use core::f32::consts::{FRAC_2_PI, TAU};

use kestirim_arithmetic::sqrt;

/// √(x² + y²), with the squares scaled where they would overflow or underflow. Never inlined: without
/// an instruction for it, the code for three square roots would take half a kilobyte at every call.
#[inline(never)]
pub(crate) fn hypot(x: f32, y: f32) -> f32 {
    const SCALE: f32 = 18_446_744_073_709_551_616.0; // 2⁶⁴
    let square = x * x + y * y;
    if (1e-30..1e30).contains(&square) {
        sqrt(square)
    } else if x.abs() > 1.0 || y.abs() > 1.0 {
        let (x, y) = (x / SCALE, y / SCALE);
        sqrt(x * x + y * y) * SCALE
    } else {
        let (x, y) = (x * SCALE, y * SCALE);
        sqrt(x * x + y * y) / SCALE
    }
}

/// (sin x, cos x) within 1.3·10⁻⁷ for |x| ≤ 8192; beyond, the last bit of x itself limits the accuracy.
///
/// Cody and Waite's reduction by π/2 in three parts, then the polynomials of Moshier's Cephes.
pub(crate) fn sin_cos(x: f32) -> (f32, f32) {
    if !x.is_finite() {
        return (f32::NAN, f32::NAN);
    }
    let x = if x.abs() > 8192.0 { within_a_turn(x) } else { x };
    let turns = x * FRAC_2_PI;
    let quadrant = (if turns < 0.0 { turns - 0.5 } else { turns + 0.5 }) as i32;
    let n = quadrant as f32;
    // π/2 as a sum of three parts, the first two of which times n are exact.
    let r = ((x - n * 1.570_312_5) - n * 4.837_513e-4) - n * 7.549_79e-8;
    let square = r * r;
    let sine =
        r + r * square * (-1.666_665_5e-1 + square * (8.332_161e-3 - square * 1.951_529_6e-4));
    let cosine = 1.0 - 0.5 * square
        + square * square * (4.166_664_6e-2 + square * (-1.388_731_6e-3 + square * 2.443_315_7e-5));
    match quadrant & 3 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// An angle beyond 8192 rad, reduced to −π..=π. From 2²¹ rad on, where adjacent numbers are a quarter of a radian
/// apart, the result is that of ±(2²¹ − 2⁻¹⁰) rad. The remainder of a division would link a kilobyte.
#[cold]
#[inline(never)]
fn within_a_turn(x: f32) -> f32 {
    /// 2⁶⁴ / (1024 · 2π): 2⁻¹⁰ rad in units of 2⁻⁶⁴ turns, so that whole turns overflow and vanish.
    const OF_A_TURN: i64 = 2_867_080_569_611_329;
    // Such an angle is a multiple of 2⁻¹⁰ rad.
    let steps = ((x * 1024.0) as i32).max(-i32::MAX);
    let turn = (i64::from(steps).wrapping_mul(OF_A_TURN) >> 32) as i32;
    turn as f32 * (TAU / 4_294_967_296.0)
}

/// Rounds a number below 2²² to an integer when added and subtracted again; the low bits of the sum hold the integer.
const ROUNDER: f32 = 12_582_912.0; // 1.5 · 2²³
/// ln 2 in two parts, the first short enough that its product with a whole number is exact.
const LN_2_HIGH: f32 = 0.693_359_4;
const LN_2_LOW: f32 = -2.121_944_4e-4;

/// eˣ with a relative error within 1.2·10⁻⁷, without branches; zero below 1.8·10⁻³⁸. Moshier's polynomial
/// (Cephes).
#[inline(always)]
pub(crate) fn exp(x: f32) -> f32 {
    // Beyond 89 the result is infinite, as it is at 89.
    let x = if x > 89.0 { 89.0 } else { x };
    let whole = x * core::f32::consts::LOG2_E + ROUNDER;
    let count = whole - ROUNDER;
    let r = (x - count * LN_2_HIGH) - count * LN_2_LOW;
    let sum = ((((1.987_569_1e-4 * r + 1.398_199_9e-3) * r + 8.333_452e-3) * r + 4.166_579_6e-2)
        * r
        + 1.666_666_5e-1)
        * r
        + 0.5;
    let value = 1.0 + (r + r * r * sum);
    // 2^(count − 1), and doubled in the end, so that the largest results do not overflow on the way.
    let power = f32::from_bits(whole.to_bits().wrapping_add(126) << 23);
    if x < -86.9 { 0.0 } else { value * power * 2.0 }
}

/// ln x within 10⁻⁷, absolute or relative, whichever is larger, without branches; a subnormal counts as zero. Moshier's
/// polynomial (Cephes).
#[inline(always)]
pub(crate) fn ln(x: f32) -> f32 {
    const C: [f32; 9] = [
        7.037_684e-2,
        -1.151_461e-1,
        1.167_699_9e-1,
        -1.242_014_1e-1,
        1.424_932_3e-1,
        -1.666_805_8e-1,
        2.000_071_5e-1,
        -2.499_999_4e-1,
        3.333_333e-1,
    ];
    const BIAS: u32 = 127;
    const ROOT_HALF: u32 = 0x3F35_04F3;
    // x = 2^exponent · (1 + f), √½ ≤ 1 + f < √2.
    let shifted = x.to_bits().wrapping_sub(ROOT_HALF).wrapping_add(BIAS << 23);
    let exponent = shifted >> 23;
    let count = exponent as i32 as f32 - 127.0;
    let f = f32::from_bits(x.to_bits().wrapping_sub(exponent << 23).wrapping_add(BIAS << 23)) - 1.0;
    let mut sum = C[0];
    for &coefficient in &C[1..] {
        sum = sum * f + coefficient;
    }
    let square = f * f;
    let value = (f + (f * square * sum + count * LN_2_LOW - 0.5 * square)) + count * LN_2_HIGH;
    let value = if x < f32::MIN_POSITIVE { f32::NEG_INFINITY } else { value };
    let value = if x < 0.0 { f32::NAN } else { value };
    // Infinity and NaN are returned as they are.
    if x <= f32::MAX { value } else { x }
}

/// The angle of (x, y) within 3·10⁻⁷, without branches; NaN if both are infinite. Moshier's polynomial
/// (Cephes).
#[inline(always)]
pub(crate) fn atan2(y: f32, x: f32) -> f32 {
    /// tan(π/8).
    const LIMIT: f32 = 0.414_213_57;
    let (ay, ax) = (y.abs(), x.abs());
    let steep = ay > ax;
    let (small, large) = if steep { (ax, ay) } else { (ay, ax) };
    // Beyond π/8, the difference from π/4 is computed instead.
    let turned = small > LIMIT * large;
    let (numerator, denominator) =
        if turned { (small - large, small + large) } else { (small, large) };
    // The angle of (0, 0) is zero.
    let ratio = numerator / if denominator == 0.0 { 1.0 } else { denominator };
    let z = ratio * ratio;
    let sum = ((8.053_744_5e-2 * z - 1.387_768_5e-1) * z + 1.997_771_1e-1) * z - 3.333_295e-1;
    let angle = ratio + ratio * z * sum;
    let angle = if turned { core::f32::consts::FRAC_PI_4 + angle } else { angle };
    let angle = if steep { core::f32::consts::FRAC_PI_2 - angle } else { angle };
    let angle = if x < 0.0 { core::f32::consts::PI - angle } else { angle };
    angle.copysign(y)
}
