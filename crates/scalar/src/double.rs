//! Double-precision functions without branches, so that loops over them are vectorised.
//!
//! The polynomials interpolate at Chebyshev nodes (computed with 60 digits); the reductions are Cody and
//! Waite's. Exponentials below 5·10⁻³⁰⁸ are zero, and subnormal arguments count as zero.

/// Rounds a number below 2⁵¹ to an integer when added and subtracted again; the low bits of the sum hold the integer.
const ROUNDER: f64 = 6_755_399_441_055_744.0; // 1.5 · 2⁵²
/// ln 2 in two parts, the first short enough that its product with a whole number is exact.
const LN_2_HIGH: f64 = 6.931_471_803_691_238e-1;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;

/// √x within one unit in the last place; 0 for zero, too small for subnormal numbers, and NaN if x is not
/// finite.
#[inline(always)]
pub(crate) fn root(x: f64) -> f64 {
    // 1/√x within 3.5 % from the bits alone; each Newton step squares the error.
    let half = 0.5 * x;
    let mut inverse = f64::from_bits(0x5FE6_EB50_C7B5_37A9_u64.wrapping_sub(x.to_bits() >> 1));
    inverse *= 1.5 - half * inverse * inverse;
    inverse *= 1.5 - half * inverse * inverse;
    inverse *= 1.5 - half * inverse * inverse;
    // The last Newton step is for √x itself.
    let root = x * inverse;
    root + (x - root * root) * (0.5 * inverse)
}

/// eˣ within 1.1 units in the last place.
#[inline(always)]
pub(crate) fn exp(x: f64) -> f64 {
    const C: [f64; 10] = [
        2.510_038_549_551_032e-8,
        2.762_008_844_540_974_6e-7,
        2.755_726_845_999_706_4e-6,
        2.480_152_129_595_437_6e-5,
        1.984_126_986_305_361_8e-4,
        1.388_888_891_721_371_7e-3,
        8.333_333_333_330_062e-3,
        4.166_666_666_662_413e-2,
        1.666_666_666_666_666_9e-1,
        0.5,
    ];
    // Beyond 710 the result is infinite, as it is at 710.
    let x = if x > 710.0 { 710.0 } else { x };
    let whole = x * core::f64::consts::LOG2_E + ROUNDER;
    let count = whole - ROUNDER;
    let rest = (x - count * LN_2_HIGH) - count * LN_2_LOW;
    let mut sum = C[0];
    for &coefficient in &C[1..] {
        sum = sum * rest + coefficient;
    }
    let value = 1.0 + (rest + rest * rest * sum);
    // 2^(count − 1), and doubled in the end, so that the largest results do not overflow on the way.
    let power = f64::from_bits(whole.to_bits().wrapping_add(1022) << 52);
    if x < -707.5 { 0.0 } else { value * power * 2.0 }
}

/// ln x within 1.5 units in the last place.
#[inline(always)]
pub(crate) fn ln(x: f64) -> f64 {
    const C: [f64; 7] = [
        1.461_644_968_508_890_6e-1,
        1.533_172_160_055_169e-1,
        1.818_288_912_526_188e-1,
        2.222_221_113_479_507_8e-1,
        2.857_142_862_597_548_7e-1,
        3.999_999_999_989_950_5e-1,
        6.666_666_666_666_67e-1,
    ];
    const BIAS: u64 = 1023;
    const ROOT_HALF: u64 = 0x3FE6_A09E_667F_3BCD;
    // x = 2^exponent · mantissa, √½ ≤ mantissa < √2.
    let shifted = x.to_bits().wrapping_sub(ROOT_HALF).wrapping_add(BIAS << 52);
    let exponent = shifted >> 52;
    let mantissa =
        f64::from_bits(x.to_bits().wrapping_sub(exponent << 52).wrapping_add(BIAS << 52));
    // An integer placed in the low bits of 2⁵² makes the double 2⁵² + integer.
    let count =
        f64::from_bits(0x4330_0000_0000_0000 | exponent) - (4_503_599_627_370_496.0 + 1023.0);
    let f = mantissa - 1.0;
    // ln(1 + f) = f − f²/2 + s·(f²/2 + R(s²)), s = f/(2 + f).
    let s = f / (2.0 + f);
    let z = s * s;
    let mut sum = C[0];
    for &coefficient in &C[1..] {
        sum = sum * z + coefficient;
    }
    let half_square = 0.5 * f * f;
    let value =
        count * LN_2_HIGH - ((half_square - (s * (half_square + z * sum) + count * LN_2_LOW)) - f);
    let value = if x < f64::MIN_POSITIVE { f64::NEG_INFINITY } else { value };
    let value = if x < 0.0 { f64::NAN } else { value };
    // Infinity and NaN are returned as they are.
    if x <= f64::MAX { value } else { x }
}

/// The angle of (x, y) within 2.5 units in the last place; NaN if both are infinite.
#[inline(always)]
pub(crate) fn atan2(y: f64, x: f64) -> f64 {
    const C: [f64; 10] = [
        2.275_052_699_326_216_4e-2,
        -4.483_334_622_264_760_5e-2,
        5.736_332_165_904_848_4e-2,
        -6.649_613_695_291_144e-2,
        7.691_055_158_393_091e-2,
        -9.090_852_557_176_045e-2,
        1.111_110_963_653_436_1e-1,
        -1.428_571_426_609_662e-1,
        1.999_999_999_989_840_7e-1,
        -3.333_333_333_333_332_5e-1,
    ];
    /// tan(π/8).
    const LIMIT: f64 = 0.414_213_562_373_095_03;
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
    let mut sum = C[0];
    for &coefficient in &C[1..] {
        sum = sum * z + coefficient;
    }
    let angle = ratio + ratio * z * sum;
    let angle = if turned { core::f64::consts::FRAC_PI_4 + angle } else { angle };
    let angle = if steep { core::f64::consts::FRAC_PI_2 - angle } else { angle };
    let angle = if x < 0.0 { core::f64::consts::PI - angle } else { angle };
    angle.copysign(y)
}
