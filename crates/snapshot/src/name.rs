use core::fmt;

/// Name of an estimator: up to 16 ASCII letters.
#[derive(Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Name([u8; Self::SIZE]);

impl Name {
    pub(crate) const SIZE: usize = 16;

    /// A name from a string, of which at most the first 16 bytes are kept.
    pub const fn new(name: &str) -> Self {
        let mut letters = [0; Self::SIZE];
        let mut index = 0;
        // Iterators cannot be used in a constant function.
        while index < Self::SIZE && index < name.len() {
            letters[index] = name.as_bytes()[index];
            index += 1;
        }
        Self(letters)
    }

    /// A hash of the name, for [`Layout::sizes`](crate::Layout::sizes): FNV-1a (Fowler, Noll and Vo 1991).
    pub const fn code(self) -> u32 {
        let (mut code, mut index) = (0x811c_9dc5_u32, 0);
        while index < Self::SIZE {
            code = (code ^ self.0[index] as u32).wrapping_mul(0x0100_0193);
            index += 1;
        }
        code
    }

    pub(crate) const fn from_bytes(bytes: [u8; Self::SIZE]) -> Self {
        Self(bytes)
    }

    pub(crate) const fn to_bytes(self) -> [u8; Self::SIZE] {
        self.0
    }
}

impl fmt::Display for Name {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let letters = self.0.iter().take_while(|&&byte| byte != 0);
        for &byte in letters {
            // Bytes not written by this crate may be anything.
            let letter = if byte.is_ascii_graphic() { char::from(byte) } else { '?' };
            fmt::Write::write_char(formatter, letter)?;
        }
        Ok(())
    }
}

impl fmt::Debug for Name {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}
