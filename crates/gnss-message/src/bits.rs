/// Reads numbers of any width from a string of bits, most significant bit first. Behind the end there are zeros.
#[derive(Debug, Clone, Copy)]
pub struct Bits<'a> {
    bytes: &'a [u8],
    place: usize,
}

impl<'a> Bits<'a> {
    /// A reader that begins at a bit, counted from 0.
    pub const fn at(bytes: &'a [u8], place: usize) -> Self {
        Self { bytes, place }
    }

    /// The bit that is read next.
    pub(crate) const fn place(&self) -> usize {
        self.place
    }

    /// Skips bits.
    pub const fn skip(&mut self, bits: usize) {
        self.place = self.place.saturating_add(bits);
    }

    /// An unsigned integer of up to 64 bits.
    pub fn integer(&mut self, bits: usize) -> u64 {
        let from = self.place;
        self.skip(bits.min(64));
        (from..self.place).fold(0, |value, place| {
            let byte = self.bytes.get(place / 8).copied().unwrap_or_default();
            value << 1 | u64::from(byte >> (7 - place % 8) & 1)
        })
    }

    /// A number in two's complement of up to 63 bits, times a power of two.
    pub fn signed(&mut self, bits: usize, power: i32) -> f64 {
        let unused = 64_u32.saturating_sub(bits as u32);
        let value = self.integer(bits).wrapping_shl(unused).cast_signed().wrapping_shr(unused);
        value as f64 * power_of_two(power)
    }

    /// An unsigned number of up to 64 bits, times a power of two.
    pub fn unsigned(&mut self, bits: usize, power: i32) -> f64 {
        self.integer(bits) as f64 * power_of_two(power)
    }
}

/// Packs numbers into N bytes, most significant bit first. What has no room is dropped.
pub(crate) struct Packer<const N: usize> {
    bytes: [u8; N],
    place: usize,
}

impl<const N: usize> Packer<N> {
    pub(crate) const fn new() -> Self {
        Self { bytes: [0; N], place: 0 }
    }

    /// Appends the lowest bits of a number.
    pub(crate) fn push(mut self, value: u64, bits: u32) -> Self {
        for bit in (0..bits).rev() {
            if let Some(byte) = self.bytes.get_mut(self.place / 8) {
                *byte |= (value.wrapping_shr(bit) as u8 & 1) << (7 - self.place % 8);
            }
            self.place = self.place.saturating_add(1);
        }
        self
    }

    /// Appends bits of another string.
    pub(crate) fn copy(self, mut from: Bits<'_>, bits: usize) -> Self {
        (0..bits).fold(self, |packed, _| packed.push(from.integer(1), 1))
    }

    pub(crate) const fn bytes(self) -> [u8; N] {
        self.bytes
    }
}

/// 2ⁿ for −1022 ≤ n ≤ 1023.
const fn power_of_two(n: i32) -> f64 {
    f64::from_bits((n.wrapping_add(1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_begin_and_end_within_bytes() {
        let mut bits = Bits::at(&[0b0001_0110, 0b1111_1101, 0b1000_0000], 3);
        assert_eq!(bits.integer(4), 0b1011);
        assert_eq!(bits.signed(7, -2), 15.75);
        bits.skip(2);
        assert_eq!(bits.unsigned(1, 10), 1024.0);
        assert_eq!((bits.integer(7), bits.integer(64)), (0, 0), "behind the end");
    }

    #[test]
    fn the_highest_bit_is_the_sign() {
        assert_eq!(Bits::at(&[0x80, 0, 0, 0], 0).signed(32, 0), f64::from(i32::MIN));
        assert_eq!(Bits::at(&[0x7f, 0xff], 0).signed(16, -15), 1.0 - 2_f64.powi(-15));
        assert_eq!(Bits::at(&[0xff], 0).signed(8, -55), -(2_f64.powi(-55)));
    }
}
