//! Square roots.

use super::Fixed;
use super::wide::{unsigned_high, unsigned_product};

impl<const FRAC: u32> Fixed<FRAC> {
    #[inline]
    pub(super) fn square_root(self) -> Self {
        Self(match u64::try_from(self.0) {
            Ok(value) => nearest_root(value << FRAC) as i32,
            Err(_) => i32::MIN,
        })
    }

    #[inline]
    pub(super) fn hypotenuse(self, other: Self) -> Self {
        let (x, y) = (self.0.unsigned_abs(), other.0.unsigned_abs());
        let square = unsigned_product(x, x) + unsigned_product(y, y);
        Self(i32::try_from(nearest_root(square)).unwrap_or(i32::MAX))
    }

    #[inline]
    pub(super) fn length(components: &[Self]) -> Self {
        // Beyond 2⁶² the root is above the upper rail.
        let square = Self::square_length(components).min(1 << 62);
        Self(i32::try_from(nearest_root(square)).unwrap_or(i32::MAX))
    }

    /// Σ xᵢ² with 2·FRAC fractional bits; saturates.
    #[inline]
    pub(super) fn square_length(components: &[Self]) -> u64 {
        let mut square = 0_u64;
        for component in components {
            let size = component.0.unsigned_abs();
            square = square.saturating_add(unsigned_product(size, size));
        }
        square
    }
}

/// √n rounded to the nearest integer, for n ≤ 2⁶³.
///
/// A parabola approximates 1/√x; Newton steps, each with only the bits it needs, refine it, the
/// last one for √x itself.
#[inline]
fn nearest_root(n: u64) -> u32 {
    if n == 0 {
        return 0;
    }
    let half_zeros = n.leading_zeros() / 2;
    let scaled = n << (2 * half_zeros);
    let x = (scaled >> 32) as u32;
    let short = x >> 16;
    // 2.6708 − 3.2854·x + 1.6386·x² for 1/√x, within 2.4 %; 14 fractional bits.
    let y = 43_759 - (((53_828 - ((26_846 * short) >> 16)) * short) >> 16);
    // y + y·(1 − x·y²)/2, within 10⁻³; 15 fractional bits.
    let error = (1_u32 << 31).wrapping_sub(((y * y) >> 13) * short) as i32;
    let y = (2 * y).wrapping_add_signed((y as i32 * (error >> 14)) >> 17);
    // Within 1.4·10⁻⁶; 30 fractional bits.
    let error = (1 << 30) - unsigned_high(x, y * y) as i32;
    let y = (y << 15).wrapping_add_signed((y as i32 * (error >> 7)) >> 9);
    // √x = x·y, refined by the same step once more: all bits, at most one unit too small.
    let root = unsigned_high(x, y) << 2;
    let error = (scaled.wrapping_sub(unsigned_product(root, root)) as i64 >> 31) as i32;
    let root = root.wrapping_add_signed((error * (y >> 16) as i32) >> 16) >> half_zeros;
    // (r + ½)² lies between r² + r and r² + r + 1.
    let rest = n.wrapping_sub(unsigned_product(root, root));
    let above = rest.wrapping_sub(u64::from(root));
    if rest <= u64::from(root) {
        root
    } else if above <= 2 * u64::from(root) + 2 {
        root + 1
    } else {
        root + 2
    }
}
