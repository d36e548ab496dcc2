//! Elementary functions in single precision, from single-precision operations only.
//!
//! `libm` computes `sinf`, `cosf` and `hypotf` in double precision, which a target without a double
//! unit pays for dearly; those are written here.

pub(super) use libm::{atan2f as atan2, expf as exp, logf as ln, sqrtf as sqrt};

/// √(x² + y²), within one unit in the last place and a half.
pub(super) fn hypot(x: f32, y: f32) -> f32 {
    const BIG: f32 = 1.844_674_4e19; // 2⁶⁴
    let larger = x.abs().max(y.abs());
    // The squares of what lies between keep all their bits.
    let scale = if larger > BIG {
        1.0 / BIG
    } else if larger < 1.0 / BIG * 4096.0 {
        BIG
    } else {
        return sqrt(x * x + y * y);
    };
    let (x, y) = (x * scale, y * scale);
    sqrt(x * x + y * y) / scale
}

/// (sin x, cos x) after Cody and Waite's reduction and the minimax polynomials of Cephes (`sinf.c`).
///
/// Error at most 1.2e-7 up to [`EXACT`] radians. A larger angle stands for itself within one unit in
/// its last place.
pub(super) fn sin_cos(x: f32) -> (f32, f32) {
    /// Up to here every multiple of the parts of π/2 below is exact.
    const EXACT: f32 = 8192.0;
    /// Added to a number, rounds it to an integer that then stands in the low bits.
    const ROUND: f32 = 12_582_912.0; // 3·2²²

    // False for NaN too, whose remainder is NaN.
    let x = if x.abs() <= EXACT { x } else { x % core::f32::consts::TAU };

    let shifted = x * core::f32::consts::FRAC_2_PI + ROUND;
    let quadrant = shifted.to_bits();
    let quarters = shifted - ROUND;
    // π/2 in three parts, the first two short enough for an exact product.
    let r = ((x - quarters * 1.570_312_5) - quarters * 4.837_513e-4) - quarters * 7.549_79e-8;

    let z = r * r;
    let sin = r + r * z * (-0.166_666_55 + z * (8.332_161e-3 - z * 1.951_529_6e-4));
    let cos = 1.0 - 0.5 * z
        + z * z * (4.166_664_6e-2 + z * (-1.388_731_6e-3 + z * 2.443_315_7e-5));

    let (sin, cos) = if quadrant & 1 == 0 { (sin, cos) } else { (cos, -sin) };
    if quadrant & 2 == 0 { (sin, cos) } else { (-sin, -cos) }
}
