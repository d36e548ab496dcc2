//! Satellite systems, and the numbers that identify satellites.

use crate::fields::integer;

/// A satellite system that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum System {
    /// GPS.
    Gps,
    /// Galileo.
    Galileo,
    /// GLONASS.
    Glonass,
    /// BeiDou.
    BeiDou,
}

/// The largest number of a GPS satellite's name.
const GPS: u8 = 99;
/// The number of a Galileo satellite is that of its name plus this.
const GALILEO: u8 = 100;
/// The number of a GLONASS satellite is that of its name plus this.
const GLONASS: u8 = 150;
/// The number of a BeiDou satellite is that of its name, up to 63, plus this.
const BEIDOU: u8 = 180;

impl System {
    /// All systems.
    pub const ALL: [Self; 4] = [Self::Gps, Self::Galileo, Self::Glonass, Self::BeiDou];

    /// The system to which a satellite number belongs.
    pub const fn of(satellite: u8) -> Self {
        if satellite <= GALILEO {
            Self::Gps
        } else if satellite <= GLONASS {
            Self::Galileo
        } else if satellite <= BEIDOU {
            Self::Glonass
        } else {
            Self::BeiDou
        }
    }

    /// The satellite number of the number in a satellite's name; `None` if no satellite has that name.
    pub(crate) fn number(self, of_name: u8) -> Option<u8> {
        let most = match self {
            Self::Gps => GPS,
            Self::Galileo => GLONASS - GALILEO - 1,
            Self::Glonass => BEIDOU - GLONASS - 1,
            Self::BeiDou => u8::MAX - BEIDOU,
        };
        (1..=most).contains(&of_name).then(|| self.behind() + of_name)
    }

    /// The system denoted by a letter.
    pub(crate) const fn of_letter(letter: u8) -> Option<Self> {
        match letter {
            b'G' => Some(Self::Gps),
            b'E' => Some(Self::Galileo),
            b'R' => Some(Self::Glonass),
            b'C' => Some(Self::BeiDou),
            _ => None,
        }
    }

    /// Whether a satellite is geostationary (BeiDou): its orbit is known far less accurately, and its ephemeris is of
    /// another kind.
    pub const fn is_geostationary(satellite: u8) -> bool {
        matches!(satellite.checked_sub(BEIDOU), Some(1..=5 | 59..=63))
    }

    /// The letter with which the names of the system's satellites begin.
    pub(crate) const fn letter(self) -> u8 {
        match self {
            Self::Gps => b'G',
            Self::Galileo => b'E',
            Self::Glonass => b'R',
            Self::BeiDou => b'C',
        }
    }

    const fn behind(self) -> u8 {
        match self {
            Self::Gps => 0,
            Self::Galileo => GALILEO,
            Self::Glonass => GLONASS,
            Self::BeiDou => BEIDOU,
        }
    }
}

/// The number of a satellite from its name (`G05`, `E 5`, or ` 5` where GPS is implied): that of the name for GPS, plus
/// 100 for Galileo, plus 150 for GLONASS, plus 180 for BeiDou.
pub(crate) fn satellite(name: &[u8]) -> Option<u8> {
    let (system, digits) = match name.split_first() {
        Some((letter, digits)) if letter.is_ascii_alphabetic() => {
            (System::of_letter(*letter)?, digits)
        }
        _ => (System::Gps, name),
    };
    system.number(u8::try_from(integer(digits.trim_ascii())?).ok()?)
}

/// The number of a GPS satellite named `G05`, `G 5`, or ` 5` where GPS is implied.
pub(crate) fn gps_satellite(name: &[u8]) -> Option<u8> {
    satellite(name).filter(|number| System::of(*number) == System::Gps)
}

/// The name of a satellite from its number: `G05`, `E05`, `R05`, `C05`.
pub fn satellite_name(number: u8) -> String {
    let system = System::of(number);
    format!("{}{:02}", char::from(system.letter()), number - system.behind())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn satellites_with_and_without_letter() {
        assert_eq!(gps_satellite(b"G05"), Some(5));
        assert_eq!(gps_satellite(b"G 5"), Some(5));
        assert_eq!(gps_satellite(b" 31"), Some(31));
        assert_eq!(gps_satellite(b"R05"), None);
        assert_eq!(gps_satellite(b"G00"), None);
        assert_eq!((satellite(b"E05"), satellite(b"G05")), (Some(105), Some(5)));
        assert_eq!((satellite(b"E 5"), satellite(b"J05")), (Some(105), None));
        assert_eq!((satellite(b"E"), satellite(b"EG5"), satellite(b"E00")), (None, None, None));
        assert_eq!((satellite(b"R24"), satellite(b"C59")), (Some(174), Some(239)));
        assert_eq!((satellite(b"E50"), satellite(b"R30"), satellite(b"C76")), (None, None, None));
    }

    #[test]
    fn names_and_numbers_are_one_to_one() {
        let mut named = 0;
        for number in 1..=u8::MAX {
            let name = satellite_name(number);
            if let Some(back) = satellite(name.as_bytes()) {
                assert_eq!((back, System::of(back)), (number, System::of(number)));
                named += 1;
            }
        }
        assert_eq!(named, 99 + 49 + 29 + 75);
        let geostationary = (1..=u8::MAX).filter(|number| System::is_geostationary(*number));
        let names: Vec<_> = geostationary.map(satellite_name).collect();
        assert_eq!(names.join(" "), "C01 C02 C03 C04 C05 C59 C60 C61 C62 C63");
    }
}
