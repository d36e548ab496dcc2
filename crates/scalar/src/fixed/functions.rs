//! Elementary functions in integers.
//!
//! Each reduces its argument to an interval around zero, or from zero to one, where a short minimax polynomial
//! (by Remez's algorithm) is evaluated by Horner's rule in the upper halves of 64-bit products. So the error does
//! not depend on FRAC, as long as FRAC can resolve it.

use super::Fixed;
use super::divisor::reciprocal;
use super::wide::{high, product, unsigned_high, unsigned_product};

impl<const FRAC: u32> Fixed<FRAC> {
    /// (sin, cos) within 4·10⁻⁸ plus half a unit in the last place.
    #[inline]
    pub(super) fn sine_cosine(self) -> (Self, Self) {
        // 2⁶⁴/2π: a full turn is 64 bits, so whole turns wrap around.
        const TURN: u64 = 2_935_890_503_282_001_226;
        let turn = (TURN >> FRAC) + ((TURN >> (FRAC - 1)) & 1);
        let x = self.0 as u32;
        let low = unsigned_product(x, turn as u32);
        // The sign bit of x counts for −2³² times the constant.
        let sign = if self.0 < 0 { turn as u32 } else { 0 };
        let phase = ((low >> 32) as u32)
            .wrapping_add(x.wrapping_mul((turn >> 32) as u32))
            .wrapping_sub(sign);
        let quadrant = phase.wrapping_add(1 << 29) >> 30;
        // The offset from the quadrant's axis, up to an eighth of a turn to either side, in Q32 quarter turns.
        let u = (phase.wrapping_sub(quadrant << 30) << 2) as i32;
        let z = high(u, u);
        let sine = high(
            1_686_629_690 + high(-693_597_423 + high(85_551_349 + high(-4_930_933, z), z), z),
            u,
        );
        let cosine =
            (1 << 30) + high(-1_324_673_091 + high(272_307_758 + high(-21_932_519, z), z), z);
        let (sine, cosine) = if quadrant & 1 == 0 { (sine, cosine) } else { (cosine, -sine) };
        let (sine, cosine) = if quadrant & 2 == 0 { (sine, cosine) } else { (-sine, -cosine) };
        (Self::rescaled(sine, 30), Self::rescaled(cosine, 30))
    }

    /// The angle of (x, y) within 3·10⁻⁷ plus half a unit in the last place.
    #[inline]
    pub(super) fn arc_tangent(y: Self, x: Self) -> Self {
        /// π in Q29.
        const PI: i32 = 1_686_629_713;
        /// Coefficients of the odd powers, highest first, in Q30.
        const C: [i32; 7] = [
            468_102_589,
            -1_154_631_809,
            1_367_924_039,
            -1_136_735_367,
            850_739_192,
            -715_485_030,
            1_073_737_649,
        ];
        let (ay, ax) = (y.0.unsigned_abs(), x.0.unsigned_abs());
        let steep = ay > ax;
        let (small, large) = if steep { (ax, ay) } else { (ay, ax) };
        if large == 0 {
            return Self(0);
        }
        let zeros = large.leading_zeros();
        let ratio = unsigned_high(small << zeros, reciprocal(large << zeros));
        let ratio = ratio.min(i32::MAX as u32) as i32;
        let z = high(ratio, ratio) << 1;
        let sum = C.into_iter().fold(0, |sum, c| c + high(sum, z));
        let angle = high(sum, ratio);
        let angle = if steep { PI / 2 - angle } else { angle };
        let angle = if x.0 < 0 { PI - angle } else { angle };
        Self::rescaled(if y.0 < 0 { -angle } else { angle }, 29)
    }

    /// eˣ with a relative error within 10⁻⁷, plus half a unit in the last place.
    #[inline]
    pub(super) fn exponential(self) -> Self {
        /// log₂ e in Q30.
        const LOG2_E: i32 = 1_549_082_005;
        /// Coefficients of (2ᵖ − 1)/p, highest power first, in Q31.
        const C: [i32; 5] = [64_154_107, 154_911_395, 479_317_606, 1_031_498_459, 1_488_531_108];
        // x·log₂e = whole + part; 2^whole is a shift.
        let power = product(self.0, LOG2_E);
        let whole = (power >> (FRAC + 30)) as i32;
        let part = (power >> (FRAC - 1)) as i32 & i32::MAX;
        let sum = C.into_iter().fold(0, |sum, c| c + high(sum, part));
        let value = (1 << 30) + high(sum, part) as u32;
        let shift = 30 - FRAC as i32 - whole;
        Self(match shift {
            ..0 => i32::MAX,
            0 => i32::try_from(value).unwrap_or(i32::MAX),
            1..=31 => (((value >> (shift - 1)) + 1) >> 1) as i32,
            _ => 0,
        })
    }

    /// ln x within 3·10⁻⁷ plus half a unit in the last place.
    #[inline]
    pub(super) fn logarithm(self) -> Self {
        if self.0 <= 0 {
            return Self(i32::MIN);
        }
        let zeros = self.0.leading_zeros();
        let (whole, part) = split_logarithm((self.0 as u32) << zeros);
        let whole = whole + 31 - zeros as i32 - FRAC as i32;
        Self::rescaled(((part + 8) >> 4) + whole * LN_2, 26)
    }

    /// The natural logarithm of a vector's length within 2·10⁻⁷ plus half a unit in the last place.
    #[inline]
    pub(super) fn log_length(components: &[Self]) -> Self {
        let square = Self::square_length(components);
        if square == 0 {
            return Self(i32::MIN);
        }
        let zeros = square.leading_zeros();
        let (whole, part) = split_logarithm(((square << zeros) >> 32) as u32);
        let whole = whole + 63 - zeros as i32 - 2 * FRAC as i32;
        // The root halves the logarithm of the square.
        Self::rescaled(((part + 16) >> 5) + whole * (LN_2 / 2), 26)
    }
}

/// ln 2 in Q26.
const LN_2: i32 = 46_516_320;

/// The logarithm of a number from 1 to 2 in Q31, as a multiple of ln 2 and a remainder in Q30.
///
/// Where half of the number is nearer to 1, the remainder is the logarithm of that half.
#[inline]
fn split_logarithm(mantissa: u32) -> (i32, i32) {
    /// Coefficients of ln(1 + t)/t, highest power first, in Q30.
    const C: [i32; 7] = [
        126_996_643,
        -202_958_491,
        221_240_990,
        -267_161_345,
        357_591_443,
        -536_892_013,
        1_073_745_311,
    ];
    let halved = mantissa >= 3_037_000_500;
    let t = if halved { mantissa } else { mantissa << 1 } as i32;
    let sum = C.into_iter().fold(0, |sum, c| c + high(sum, t));
    (i32::from(halved), high(sum, t))
}
