//! Single-precision functions which never touch double precision.

use core::f32::consts::{FRAC_2_PI, TAU};

/// Whether the machine multiplies in hardware.
const FPU: bool = cfg!(not(any(
    all(target_arch = "arm", not(target_abi = "eabihf")),
    all(target_arch = "riscv32", not(target_feature = "f"))
)));

/// √x within one unit in the last place, with IEEE's edges.
#[inline]
pub(crate) fn sqrt(x: f32) -> f32 {
    if (f32::MIN_POSITIVE..=f32::MAX).contains(&x) { root(x) } else { libm::sqrtf(x) }
}

/// √x within one unit in the last place; of zero 0, of what is subnormal too little, and of what is not
/// finite NaN.
///
/// The square root instruction of a Cortex-M4F is out of reach of stable Rust without `std`, and libm's
/// integer square root costs twice as much as this where multiplications are cheap.
#[inline]
pub(crate) fn root(x: f32) -> f32 {
    if !FPU {
        return libm::sqrtf(x);
    }
    // 1/√x within 3.5 % from the bits alone; each of Newton's steps squares that.
    let half = 0.5 * x;
    let mut inverse = f32::from_bits(0x5F37_59DF_u32.wrapping_sub(x.to_bits() >> 1));
    inverse *= 1.5 - half * inverse * inverse;
    inverse *= 1.5 - half * inverse * inverse;
    // And the last one for √x itself.
    let root = x * inverse;
    root + (x - root * root) * (0.5 * inverse)
}

/// √(x² + y²); the squares are scaled where they would overflow or vanish. Never inlined: three square roots
/// at every place of use would be half a kilobyte each.
#[inline(never)]
pub(crate) fn hypot(x: f32, y: f32) -> f32 {
    const SCALE: f32 = 18_446_744_073_709_551_616.0; // 2⁶⁴
    let square = x * x + y * y;
    if (1e-30..1e30).contains(&square) {
        libm::sqrtf(square)
    } else if x.abs() > 1.0 || y.abs() > 1.0 {
        let (x, y) = (x / SCALE, y / SCALE);
        libm::sqrtf(x * x + y * y) * SCALE
    } else {
        let (x, y) = (x * SCALE, y * SCALE);
        libm::sqrtf(x * x + y * y) / SCALE
    }
}

/// (sin x, cos x) within 1.3·10⁻⁷ for |x| ≤ 8192; beyond, x itself is known no better than its last bit.
///
/// Cody and Waite's reduction by π/2 in three parts, then the polynomials of Moshier's Cephes.
pub(crate) fn sin_cos(x: f32) -> (f32, f32) {
    if !x.is_finite() {
        return (f32::NAN, f32::NAN);
    }
    let x = if x.abs() > 8192.0 { x % TAU } else { x };
    let turns = x * FRAC_2_PI;
    let quadrant = (if turns < 0.0 { turns - 0.5 } else { turns + 0.5 }) as i32;
    let n = quadrant as f32;
    // π/2 as a sum of which the first two parts times n are exact.
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
