//! The implementation of [`Scalar`] for fixed point.

use super::wide::product;
use super::{Fixed, FixedDivisor};
use crate::Scalar;

impl<const FRAC: u32> Fixed<FRAC> {
    /// 2ᶠᴿᴬᶜ as a double, the factor of conversions.
    const TO_BITS: f64 = Self::SCALE as f64;

    #[inline(always)]
    const fn rounded(value: f64) -> Self {
        let scaled = value * Self::TO_BITS;
        if value.is_nan() {
            return Self(i32::MIN);
        }
        Self((if scaled < 0.0 { scaled - 0.5 } else { scaled + 0.5 }) as i32)
    }
}

/// value · 2^by, rounded to nearest, saturating.
#[inline(always)]
fn shifted(value: i32, by: i32) -> i32 {
    match by {
        ..-31 => 0,
        -31..0 => (((i64::from(value) >> (-by - 1)) + 1) >> 1) as i32,
        0..32 => match i32::try_from(i64::from(value) << by) {
            Ok(bits) => bits,
            Err(_) => saturation(value),
        },
        _ if value == 0 => 0,
        _ => saturation(value),
    }
}

/// The rail on the side of the sign of `value`.
#[inline(always)]
fn saturation(value: i32) -> i32 {
    if value < 0 { i32::MIN } else { i32::MAX }
}

impl<const FRAC: u32> Scalar for Fixed<FRAC> {
    /// A sum in units of 2⁻²ᶠᴿᴬᶜ: two products of rails fit; beyond that it saturates.
    type Accumulator = i64;
    type Divisor = FixedDivisor<FRAC>;

    const ZERO: Self = Self(0);
    const ONE: Self = Self(Self::SCALE);
    const HALF: Self = Self(Self::SCALE >> 1);
    const TWO: Self = Self::saturate(2 * Self::SCALE as i64);
    const PI: Self = Self::rounded(core::f64::consts::PI);
    const EPSILON: Self = Self(1);
    const MIN: Self = Self(i32::MIN);
    const MAX: Self = Self(i32::MAX);
    const MAX_WHOLE: u32 = i32::MAX as u32 >> FRAC;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::rounded(value)
    }
    #[inline]
    fn to_f64(self) -> f64 {
        f64::from(self.0) / Self::TO_BITS
    }
    #[inline]
    fn from_f32(value: f32) -> Self {
        // Uses integers only, from the fields of the float: software floating point would cost ten times as much.
        let (bits, negative) = (value.to_bits() & 0x7FFF_FFFF, value.is_sign_negative());
        if value.is_nan() {
            return Self(i32::MIN);
        }
        // A subnormal number rounds to zero in any case.
        let mantissa = (bits & 0x7F_FFFF) | 0x80_0000;
        let shift = (bits >> 23) as i32 - 150 + FRAC as i32;
        let magnitude = match shift {
            ..-24 => 0,
            -24..0 => ((mantissa >> (-shift - 1)) + 1) >> 1,
            0..8 => mantissa << shift,
            _ => return Self(if negative { i32::MIN } else { i32::MAX }),
        };
        let magnitude = i32::try_from(magnitude);
        Self(match (magnitude, negative) {
            (Ok(magnitude), false) => magnitude,
            (Ok(magnitude), true) => -magnitude,
            (Err(_), false) => i32::MAX,
            (Err(_), true) => i32::MIN,
        })
    }
    #[inline]
    fn to_f32(self) -> f32 {
        self.0 as f32 / Self::SCALE as f32
    }
    #[inline]
    fn from_micro(value: i32) -> Self {
        // 10⁻⁶ · 2⁵¹ is exact to 2·10⁻¹⁰; FRAC ≤ 30 leaves at least 21 bits to round away.
        const MICRO_Q51: i64 = 2_251_799_814;
        let shift = 51 - FRAC;
        Self::saturate((i64::from(value) * MICRO_Q51 + (1 << (shift - 1))) >> shift)
    }

    #[inline(always)]
    fn from_binary(value: i32, exponent: i32) -> Self {
        Self(shifted(value, exponent.saturating_add(FRAC as i32)))
    }
    #[inline(always)]
    fn to_binary(self, exponent: i32) -> i32 {
        shifted(self.0, exponent.saturating_add(FRAC as i32).saturating_neg())
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.0 != i32::MIN && self.0 != i32::MAX
    }
    #[inline]
    fn is_positive(self) -> bool {
        self.0 > 0 && self.0 != i32::MAX
    }
    #[inline]
    fn abs(self) -> Self {
        Self(self.0.saturating_abs())
    }

    #[inline]
    fn sqrt(self) -> Self {
        self.square_root()
    }
    #[inline]
    fn hypot(self, other: Self) -> Self {
        self.hypotenuse(other)
    }
    #[inline]
    fn norm<const N: usize>(components: &[Self; N]) -> Self {
        Self::length(components)
    }
    #[inline]
    fn ln_norm<const N: usize>(components: &[Self; N]) -> Self {
        Self::log_length(components)
    }
    #[inline]
    fn recip(self) -> Self {
        if self.0 == 0 { Self(i32::MAX) } else { Self::ONE / self }
    }
    #[inline]
    fn divisor(self) -> FixedDivisor<FRAC> {
        FixedDivisor::new(self)
    }
    #[inline]
    fn divided_by(self, divisor: FixedDivisor<FRAC>) -> Self {
        divisor.divide(self)
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        self.sine_cosine()
    }
    #[inline]
    fn atan2(self, other: Self) -> Self {
        Self::arc_tangent(self, other)
    }
    #[inline]
    fn exp(self) -> Self {
        self.exponential()
    }
    #[inline]
    fn ln(self) -> Self {
        self.logarithm()
    }

    #[inline]
    fn rounding(self, count: u16) -> Self {
        let each = (self.0.unsigned_abs() >> FRAC) + 1;
        let halves = each.saturating_mul(u32::from(count));
        Self((halves / 2 + halves % 2) as i32)
    }

    #[inline]
    fn accumulator() -> i64 {
        0
    }
    #[inline]
    fn mac(sum: i64, a: Self, b: Self) -> i64 {
        sum.saturating_add(product(a.0, b.0))
    }
    #[inline]
    fn finish(sum: i64) -> Self {
        Self::narrowed(sum)
    }

    #[inline]
    fn headroom(exponent: i32) -> Option<u32> {
        // Coefficients of 31 bits in all and factors of 31 bits make sums of up to 2⁶²; the remainder of a rounding may
        // be as large.
        u32::try_from(31 - FRAC as i32 - exponent).ok().map(|bits| bits.min(62 - FRAC))
    }
    #[inline(always)]
    fn mac_within(sum: i64, a: Self, b: Self) -> i64 {
        sum.wrapping_add(product(a.0, b.0))
    }
    #[inline(always)]
    fn advanced(self, sum: i64, shift: u32) -> (Self, i64) {
        let shift = shift.min(62 - FRAC) + FRAC;
        let whole = (sum >> (shift - 1)).wrapping_add(1) >> 1;
        let next = Self::saturate(i64::from(self.0) + whole);
        (next, sum.wrapping_sub(whole << shift))
    }
}
