//! Satellites of systems that are not read.

/// The systems by the letter of their satellites, in the order in which they are named. Galileo, GLONASS and BeiDou are
/// listed because RINEX 2 files of them are not read, and some data of them elsewhere is not either.
const SYSTEMS: [(u8, &str); 6] = [
    (b'E', "Galileo"),
    (b'R', "GLONASS"),
    (b'C', "BeiDou"),
    (b'J', "QZSS"),
    (b'I', "NavIC"),
    (b'S', "SBAS"),
];

/// The set of satellites that are not read: a bit for each number of a system, as observations note a satellite for
/// every line.
#[derive(Debug, Clone, Default)]
pub(crate) struct Unserved([u128; SYSTEMS.len()]);

impl Unserved {
    /// Notes a satellite by its name, unless its system is unknown.
    pub(crate) fn note_name(&mut self, [letter, tens, ones]: [u8; 3]) {
        let digit = |byte: u8| byte.is_ascii_digit().then(|| byte - b'0');
        // RINEX allows both R01 and R 1.
        let tens = if tens == b' ' { Some(0) } else { digit(tens) };
        let (Some(tens), Some(ones)) = (tens, digit(ones)) else { return };
        self.note(letter, 10 * tens + ones);
    }

    /// Notes a satellite by the letter of its system and its number, unless either is unknown.
    pub(crate) fn note(&mut self, letter: u8, number: u8) {
        let Some(bit) = 1_u128.checked_shl(u32::from(number)) else { return };
        for ((of, _), seen) in SYSTEMS.iter().zip(&mut self.0) {
            if *of == letter {
                *seen |= bit;
            }
        }
    }

    /// A sentence that counts the satellites by system, if there are any; `what` is the satellites themselves or their
    /// ephemerides.
    pub(crate) fn sentence(&self, what: &str) -> Option<String> {
        let told = SYSTEMS.iter().zip(self.0).filter(|(_, seen)| *seen != 0);
        let told = told.map(|((_, system), seen)| format!("{system} ({})", seen.count_ones()));
        let satellites = told.collect::<Vec<_>>().join(", ");
        (!satellites.is_empty())
            .then(|| format!("{what} of {satellites} are in the file, but are not read"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_satellite_counts_once() {
        let mut unserved = Unserved::default();
        for name in [b"C19", b"R01", b"R 1", b"R24", b"X01", b"   "] {
            unserved.note_name(*name);
        }
        unserved.note(b'R', 24);
        unserved.note(b'R', 255);
        let expected = "satellites of GLONASS (2), BeiDou (1) are in the file, but are not read";
        assert_eq!(unserved.sentence("satellites").as_deref(), Some(expected));
        assert_eq!(Unserved::default().sentence("satellites"), None);
    }
}
