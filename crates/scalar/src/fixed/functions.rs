//! Elementary functions in integers.
//!
//! Each reduces its argument to [0, 1), where a short polynomial (fitted by Lawson's iteration towards
//! the minimax) is evaluated in Q29 by Horner's rule. The multiplications by the reduced argument,
//! 17 bits of it, are two 32-bit ones ([`scale`]): ARMv6-M has no wider.

use super::Fixed;

/// π in Q29.
const PI_Q29: i32 = 1_686_629_713;
/// 1/(2π) in Q32.
const TURNS_Q32: i64 = 683_565_276;
/// log₂ e in Q30.
const LOG2_E_Q30: i64 = 1_549_082_005;
/// ln 2 in Q26.
const LN_2_Q26: i32 = 46_516_320;

const fn q29(value: f64) -> i32 {
    let scaled = value * (1_u64 << 29) as f64;
    (if scaled < 0.0 { scaled - 0.5 } else { scaled + 0.5 }) as i32
}

/// value · x for x in Q16, 0 ≤ x ≤ 1, |value| ≤ 2³⁰.
#[inline(always)]
const fn scale(value: i32, x: u32) -> i32 {
    let high = (value >> 16).wrapping_mul(x as i32);
    let low = (value as u32 & 0xffff).wrapping_mul(x) >> 16;
    high.wrapping_add(low as i32)
}

/// c₀ + c₁·x + c₂·x² …, in Q29, for x in Q16.
#[inline(always)]
fn polynomial<const N: usize>(coefficients: &[i32; N], x: u32) -> i32 {
    coefficients.iter().rev().fold(0, |sum, &c| c.wrapping_add(scale(sum, x)))
}

/// ⌊√value⌋, a bit at a time.
#[inline]
fn integer_sqrt(value: u64) -> u32 {
    if value == 0 {
        return 0;
    }
    let mut rest = value;
    let mut root = 0_u64;
    let mut bit = 1_u64 << ((63 - value.leading_zeros()) & !1);
    while bit != 0 {
        if rest >= root + bit {
            rest -= root + bit;
            root = (root >> 1) + bit;
        } else {
            root >>= 1;
        }
        bit >>= 2;
    }
    root as u32
}

/// The nearest integer to √value: the remainder tells which side of the half the root is on.
#[inline]
fn nearest_sqrt(value: u64) -> i64 {
    let root = u64::from(integer_sqrt(value));
    (root + u64::from(value - root * root > root)) as i64
}

/// sin of a phase, a full turn being 2³², in Q29; error 6·10⁻⁷ + rounding.
#[inline]
fn sine(phase: u32) -> i32 {
    const C: [i32; 4] =
        [q29(1.570_791_01), q29(-0.645_892_85), q29(0.079_434_35), q29(-0.004_333_10)];
    // sin(½ turn − p) = sin p: folded to a quarter turn on either side of zero.
    let phase = phase as i32;
    let folded = if phase ^ (phase << 1) < 0 { i32::MIN.wrapping_sub(phase) } else { phase };
    let t = folded >> 14;
    let magnitude = t.unsigned_abs();
    let square = (magnitude >> 1) * (magnitude >> 1) >> 14;
    let value = scale(polynomial(&C, square), magnitude);
    if t < 0 { -value } else { value }
}

impl<const FRAC: u32> Fixed<FRAC> {
    #[inline]
    pub(super) fn square_root(self) -> Self {
        if self.0 < 0 {
            return Self(i32::MIN);
        }
        Self::saturate(nearest_sqrt((self.0 as u64) << FRAC))
    }

    #[inline]
    pub(super) fn hypotenuse(self, other: Self) -> Self {
        let (x, y) = (u64::from(self.0.unsigned_abs()), u64::from(other.0.unsigned_abs()));
        Self::saturate(nearest_sqrt(x * x + y * y))
    }

    #[inline]
    pub(super) fn sine_cosine(self) -> (Self, Self) {
        let phase = ((i64::from(self.0) * TURNS_Q32) >> FRAC) as u32;
        let cosine = sine(phase.wrapping_add(1 << 30));
        (Self::from_scaled(sine(phase), 29), Self::from_scaled(cosine, 29))
    }

    #[inline]
    pub(super) fn arc_tangent(y: Self, x: Self) -> Self {
        const C: [i32; 5] = [
            q29(0.999_866_33),
            q29(-0.330_304_78),
            q29(0.180_159_21),
            q29(-0.085_156_19),
            q29(0.020_845_02),
        ];
        let (ay, ax) = (y.0.unsigned_abs(), x.0.unsigned_abs());
        let (small, large) = if ay > ax { (ax, ay) } else { (ay, ax) };
        if large == 0 {
            return Self(0);
        }
        // The ratio in Q16, by the one 32-bit division: 16 bits of the larger are enough for it.
        let shift = large.leading_zeros();
        let denominator = (((large << shift) >> 15) + 1) >> 1;
        let numerator = (small << shift).saturating_add(denominator >> 1);
        let ratio = numerator.checked_div(denominator).unwrap_or(0).min(1 << 16);
        let square = (ratio >> 1) * (ratio >> 1) >> 14;
        let angle = scale(polynomial(&C, square), ratio);
        let angle = if ay > ax { (PI_Q29 >> 1) - angle } else { angle };
        let angle = if x.0 < 0 { PI_Q29 - angle } else { angle };
        Self::from_scaled(if y.0 < 0 { -angle } else { angle }, 29)
    }

    #[inline]
    pub(super) fn exponential(self) -> Self {
        const C: [i32; 5] =
            [q29(1.0), q29(0.693_044_84), q29(0.241_280_22), q29(0.052_242_45), q29(0.013_426_70)];
        // x·log₂e = whole + part, then 2^whole is a shift.
        let power = (i64::from(self.0) * LOG2_E_Q30) >> (FRAC + 14);
        let whole = (power >> 16) as i32;
        let value = polynomial(&C, power as u32 & 0xffff);
        let shift = 29 - FRAC as i32 - whole;
        if shift > 31 {
            Self(0)
        } else if shift > 0 {
            Self(((value >> (shift - 1)) + 1) >> 1)
        } else if shift > -2 {
            Self::saturate(i64::from(value) << -shift)
        } else {
            Self(i32::MAX)
        }
    }

    #[inline]
    pub(super) fn logarithm(self) -> Self {
        const C: [i32; 7] = [
            0,
            q29(0.999_901_64),
            q29(-0.497_874_98),
            q29(0.317_648_62),
            q29(-0.193_760_05),
            q29(0.085_569_11),
            q29(-0.018_338_58),
        ];
        if self.0 <= 0 {
            return Self(i32::MIN);
        }
        let shift = self.0.leading_zeros();
        let part = ((self.0 as u32) << shift << 1) >> 16;
        let whole = 31 - shift as i32 - FRAC as i32;
        Self::from_scaled((polynomial(&C, part) >> 3) + whole * LN_2_Q26, 26)
    }
}
