//! Numbers of so many bits, as messages have them one after the other.

/// Numbers from a place on, the highest bit of each first; behind the end there are zeros.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fields<'a> {
    bytes: &'a [u8],
    place: usize,
}

impl<'a> Fields<'a> {
    /// From the bit at a place on.
    pub(super) const fn at(bytes: &'a [u8], place: usize) -> Self {
        Self { bytes, place }
    }

    /// Leaves bits out.
    pub(super) const fn skip(&mut self, bits: usize) {
        self.place += bits;
    }

    /// A number without a sign.
    pub(super) fn whole(&mut self, bits: usize) -> u64 {
        let from = self.place;
        self.skip(bits);
        (from..self.place).fold(0, |value, place| {
            let byte = self.bytes.get(place / 8).copied().unwrap_or_default();
            value << 1 | u64::from(byte >> (7 - place % 8) & 1)
        })
    }

    /// A number with a sign, in units of a power of two.
    #[cfg(feature = "ubx")]
    pub(super) fn signed(&mut self, bits: usize, power: i32) -> f64 {
        let value = self.whole(bits) as i64;
        let value = if value >> (bits - 1) == 0 { value } else { value - (1 << bits) };
        value as f64 * 2_f64.powi(power)
    }

    /// The same without a sign.
    #[cfg(feature = "ubx")]
    pub(super) fn unsigned(&mut self, bits: usize, power: i32) -> f64 {
        self.whole(bits) as f64 * 2_f64.powi(power)
    }
}
