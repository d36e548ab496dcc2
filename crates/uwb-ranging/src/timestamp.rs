//! The counter of the DW1000 and differences of its readings.

/// The speed of light in vacuum (m/s), exact. In air it is 0.03 % less: 2 cm at 60 m, which a calibration at known
/// points absorbs.
pub const SPEED_OF_LIGHT: f64 = 299_792_458.0;
/// The frequency of the counter (Hz): 128 · 499.2 MHz (DW1000 user manual, 4.1.6 and 7.2.8).
pub const TICKS_PER_SECOND: f64 = 128.0 * 499.2e6;
/// Distance that light travels in one tick (m): 4.69 mm.
pub const METRES_PER_TICK: f64 = SPEED_OF_LIGHT / TICKS_PER_SECOND;

const MASK: u64 = (1 << 40) - 1;

/// A reading of the 40-bit counter (ticks of 15.65 ps; it wraps every 17.2 s).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Timestamp(u64);

impl Timestamp {
    /// Creates a timestamp from a counter value, of which the lower 40 bits are used.
    #[inline]
    pub const fn new(ticks: u64) -> Self {
        Self(ticks & MASK)
    }

    /// Creates a timestamp from the bytes of the registers `RX_STAMP` and `TX_STAMP` or of a message field, least
    /// significant first.
    #[inline]
    pub const fn from_le_bytes([a, b, c, d, e]: [u8; 5]) -> Self {
        Self(u64::from_le_bytes([a, b, c, d, e, 0, 0, 0]))
    }

    /// The bytes as the chip orders them, least significant first.
    #[inline]
    pub const fn to_le_bytes(self) -> [u8; 5] {
        let [a, b, c, d, e, ..] = self.0.to_le_bytes();
        [a, b, c, d, e]
    }

    /// The counter value, below 2⁴⁰.
    #[inline]
    pub const fn ticks(self) -> u64 {
        self.0 & MASK
    }

    /// The interval since `earlier`, a reading of the same counter less than 17.2 s ago; correct across a wrap.
    #[inline]
    pub const fn since(self, earlier: Self) -> Ticks {
        Ticks::new(self.0.wrapping_sub(earlier.0))
    }

    /// The reading `interval` later, such as the timestamp of a delayed transmission.
    #[inline]
    pub const fn after(self, interval: Ticks) -> Self {
        Self::new(self.0.wrapping_add(interval.0))
    }
}

/// An interval between two readings of one counter (ticks of 15.65 ps, below 2⁴⁰ = 17.2 s).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ticks(u64);

impl Ticks {
    /// Creates an interval from a count of ticks, of which the lower 40 bits are used.
    #[inline]
    pub const fn new(ticks: u64) -> Self {
        Self(ticks & MASK)
    }

    /// The count, below 2⁴⁰.
    #[inline]
    pub const fn get(self) -> u64 {
        self.0 & MASK
    }

    /// The count as a signed number, for exact differences.
    #[inline]
    pub(crate) const fn signed(self) -> i64 {
        (self.0 & MASK) as i64
    }
}
