//! Clock offsets between two radios.

use crate::{Error, Ticks};
use kestirim_scalar::Scalar;

/// The channel of the radio, which sets its carrier frequency (DW1000 user manual, table 56).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Channel {
    /// Channel 1: 3494.4 MHz.
    One,
    /// Channel 2: 3993.6 MHz.
    Two,
    /// Channel 3: 4492.8 MHz.
    Three,
    /// Channel 4: 3993.6 MHz, wide.
    Four,
    /// Channel 5: 6489.6 MHz.
    Five,
    /// Channel 7: 6489.6 MHz, wide.
    Seven,
}

/// The data rate, which determines the integration time of the carrier loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum DataRate {
    /// 110 kbit/s.
    Kbps110,
    /// 850 kbit/s or 6.8 Mbit/s.
    Kbps850OrMore,
}

/// Rate of the local (initiator's) clock relative to the remote one, minus one: an interval of the remote clock
/// times (1 + offset) is the same interval on the local clock.
///
/// Limited to ±1953 ppm; two DW1000s may differ by ±40 ppm. Stored in units of 2⁻⁴⁰ whatever the scalar type, which
/// is 0.05 mm for a reply time of 200 ms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClockOffset(i32);

impl ClockOffset {
    /// Both clocks run at the same rate.
    pub const ZERO: Self = Self(0);
    /// Number of fractional bits of [`ClockOffset::to_bits`].
    pub const FRACTION: u32 = 40;

    /// Creates an offset from units of 2⁻⁴⁰.
    #[inline]
    pub const fn from_bits(bits: i32) -> Self {
        Self(bits)
    }

    /// The offset in units of 2⁻⁴⁰.
    #[inline]
    pub const fn to_bits(self) -> i32 {
        self.0
    }

    /// The offset from the carrier recovery integrator `DRX_CAR_INT`, read after a message from the remote radio:
    /// the raw register or its sign-extended value (only the lower 21 bits are used).
    ///
    /// The constants and the sign are those of Decawave's `deca_device_api.h` (`FREQ_OFFSET_MULTIPLIER`,
    /// `HERTZ_TO_PPM_MULTIPLIER_CHAN_x`), whose ratio is remote against local; this one is the inverse.
    pub fn from_carrier_integrator(integrator: i32, channel: Channel, rate: DataRate) -> Self {
        // Remote against local, per count, in units of 2⁻⁶⁴.
        let per_count = match channel {
            Channel::One => const { Self::per_count(3494.4e6) },
            Channel::Two | Channel::Four => const { Self::per_count(3993.6e6) },
            Channel::Three => const { Self::per_count(4492.8e6) },
            Channel::Five | Channel::Seven => const { Self::per_count(6489.6e6) },
        };
        let shift = match rate {
            DataRate::Kbps110 => 27,
            DataRate::Kbps850OrMore => 24,
        };
        let counts = i64::from((integrator << 11) >> 11);
        // The magnitude is below 2³¹, and that of its square below 2⁶².
        let ratio = counts.wrapping_mul(per_count).wrapping_neg() >> shift;
        // 1/(1 + ratio) − 1 = −ratio·(1 − ratio·(1 − ratio…)); the next term is 10⁻¹³ at 600 ppm.
        let second = ratio.wrapping_mul(ratio) >> Self::FRACTION;
        let series = ratio.wrapping_mul(ratio.wrapping_sub(second)) >> Self::FRACTION;
        Self::saturated(series.wrapping_sub(ratio))
    }

    /// The offset from one interval measured on both clocks: between the departures of two messages on one and
    /// their arrivals on the other. A longer interval is more accurate; the tag's motion meanwhile (its speed over
    /// c) enters the offset.
    ///
    /// # Errors
    /// [`Error::EmptyExchange`] for a remote interval of zero.
    pub fn from_intervals(local: Ticks, remote: Ticks) -> Result<Self, Error> {
        Self::between(local.signed(), remote.signed())
    }

    /// The offset in parts per million, within ±1953.
    pub fn ppm<T: Scalar>(self) -> T {
        T::from_f32(self.0 as f32 * const { (1e6 / (1_u64 << 40) as f64) as f32 })
    }

    /// Creates an offset from parts per million; saturates at ±1953, and a value that is not finite gives zero.
    pub fn from_ppm<T: Scalar>(ppm: T) -> Self {
        if !ppm.is_finite() {
            return Self::ZERO;
        }
        Self((ppm.to_f32() * const { ((1_u64 << 40) as f64 / 1e6) as f32 }) as i32)
    }

    /// local/remote − 1; the difference is exact, the quotient has a relative error of 2·10⁻⁷.
    pub(crate) fn between(local: i64, remote: i64) -> Result<Self, Error> {
        if remote <= 0 {
            return Err(Error::EmptyExchange);
        }
        let ratio = local.wrapping_sub(remote) as f32 / remote as f32;
        Ok(Self((ratio * const { (1_u64 << 40) as f32 }) as i32))
    }

    /// The ratio of one count, in units of 2⁻⁶⁴: 499.2 MHz / 1024 / 2¹⁷ (at 850 kbit/s and above) over the carrier
    /// frequency.
    const fn per_count(carrier: f64) -> i64 {
        (499.2e6 / 1024.0 / 131_072.0 / carrier * 18_446_744_073_709_551_616.0 + 0.5) as i64
    }

    const fn saturated(bits: i64) -> Self {
        if bits > i32::MAX as i64 {
            Self(i32::MAX)
        } else if bits < i32::MIN as i64 {
            Self(i32::MIN)
        } else {
            Self(bits as i32)
        }
    }
}
