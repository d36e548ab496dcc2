//! Satellites of systems that are not served.

use std::collections::BTreeSet;

/// Systems by the letter of their satellites, in the order in which they are named. Galileo stands here for RINEX 2, of which it is
/// not read.
const SYSTEMS: [(u8, &str); 6] = [
    (b'E', "Galileo"),
    (b'R', "GLONASS"),
    (b'C', "BeiDou"),
    (b'J', "QZSS"),
    (b'I', "NavIC"),
    (b'S', "SBAS"),
];

/// Satellites of systems that are not served, by their names.
#[derive(Debug, Clone, Default)]
pub(crate) struct Unserved(BTreeSet<[u8; 3]>);

impl Unserved {
    /// Takes note of a satellite, unless its system is not known.
    pub(crate) fn note(&mut self, [letter, tens, ones]: [u8; 3]) {
        if SYSTEMS.iter().any(|(of, _)| *of == letter) {
            // RINEX allows both R01 and R 1.
            self.0.insert([letter, if tens == b' ' { b'0' } else { tens }, ones]);
        }
    }

    /// A sentence about them, if there are any.
    pub(crate) fn sentence(&self) -> Option<String> {
        let count = |letter: u8| self.0.iter().filter(|name| name[0] == letter).count();
        let counts = SYSTEMS.map(|(letter, system)| (system, count(letter)));
        let told = counts.iter().filter(|(_, count)| *count > 0);
        let told: Vec<_> = told.map(|(system, count)| format!("{system} ({count})")).collect();
        let satellites = told.join(", ");
        (!told.is_empty())
            .then(|| format!("satellites of {satellites} are in the file, but are not read"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_satellite_counts_once() {
        let mut unserved = Unserved::default();
        for name in [b"C19", b"R01", b"R 1", b"R24", b"X01", b"   "] {
            unserved.note(*name);
        }
        let expected = "satellites of GLONASS (2), BeiDou (1) are in the file, but are not read";
        assert_eq!(unserved.sentence().as_deref(), Some(expected));
        assert_eq!(Unserved::default().sentence(), None);
    }
}
