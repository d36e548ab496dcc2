//! Single-precision functions which never touch double precision.

use core::f32::consts::{FRAC_2_PI, TAU};

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
