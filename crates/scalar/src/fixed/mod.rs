//! The fixed-point number: representation, conversion and arithmetic.

mod divisor;
mod functions;
mod ops;
mod root;
mod scalar;
mod wide;

pub use divisor::FixedDivisor;

use core::fmt;

/// A signed 32-bit fixed-point number with `FRAC` fractional bits (1 to 30).
///
/// The value is bits · 2⁻ᶠᴿᴬᶜ. Every operation rounds to nearest and saturates at the two rails
/// ([`i32::MIN`] and [`i32::MAX`] bits); a number on a rail has overflowed and is not
/// [finite](crate::Scalar::is_finite). Products and quotients are computed in 64 bits and rounded once.
///
/// With `serde` its bits are serialised, which is exact and takes one to five bytes in postcard; both sides must agree
/// on `FRAC`.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
#[repr(transparent)]
pub struct Fixed<const FRAC: u32>(i32);

/// Fixed point over ±32 768 in steps of 1.5·10⁻⁵.
pub type Q16_16 = Fixed<16>;
/// Fixed point over ±2048 in steps of 9.5·10⁻⁷.
pub type Q12_20 = Fixed<20>;
/// Fixed point over ±128 in steps of 6·10⁻⁸.
pub type Q8_24 = Fixed<24>;

impl<const FRAC: u32> Fixed<FRAC> {
    /// 2ᶠᴿᴬᶜ, the bits of the number one.
    const SCALE: i32 = {
        assert!(1 <= FRAC && FRAC <= 30, "half and one must be representable");
        1 << FRAC
    };

    /// The number bits · 2⁻ᶠᴿᴬᶜ.
    #[inline]
    pub const fn from_bits(bits: i32) -> Self {
        Self(bits)
    }

    /// The number · 2ᶠᴿᴬᶜ.
    #[inline]
    pub const fn to_bits(self) -> i32 {
        self.0
    }

    /// The number of these bits, saturating.
    #[inline]
    const fn saturate(bits: i64) -> Self {
        if bits > i32::MAX as i64 {
            Self(i32::MAX)
        } else if bits < i32::MIN as i64 {
            Self(i32::MIN)
        } else {
            Self(bits as i32)
        }
    }
}

impl<const FRAC: u32> fmt::Debug for Fixed<FRAC> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&crate::Scalar::to_f64(*self), formatter)
    }
}

impl<const FRAC: u32> fmt::Display for Fixed<FRAC> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&crate::Scalar::to_f64(*self), formatter)
    }
}

#[cfg(feature = "defmt")]
impl<const FRAC: u32> defmt::Format for Fixed<FRAC> {
    fn format(&self, formatter: defmt::Formatter<'_>) {
        defmt::write!(formatter, "{=f32}", crate::Scalar::to_f32(*self));
    }
}
