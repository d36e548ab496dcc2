//! Records of navigation files: their lines and the numbers in them.

use super::ephemeris::Message;
use crate::error::Error;
use crate::fields::blank_separated;
use crate::system::{System, satellite};
use crate::text::{Line, Lines};
use crate::time::{GpsTime, full_year};

/// The width of a number, columns.
const WIDTH: usize = 19;
/// The maximum number of lines of a record that are read.
const LINES: usize = 8;
/// How many numbers the first line holds.
const FIRST: usize = 3;
/// How many numbers each further line holds.
const FURTHER: usize = 4;

/// The layout of records.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    /// The major version of RINEX.
    version: i32,
    /// The system whose satellites are written as a number without a letter.
    system: Option<u8>,
}

impl Layout {
    /// The layout of a version and a file type letter; `None` if that is no navigation file.
    pub(super) const fn of(version: f64, kind: u8) -> Option<Self> {
        let version = version as i32;
        let system = match (version, kind) {
            (2, b'N') => Some(b'G'),
            (2, b'E') => Some(b'E'),
            // Files of GLONASS and of SBAS.
            (2, b'G' | b'H') | (3.., b'N') => None,
            _ => return None,
        };
        Some(Self { version, system })
    }

    /// The number of columns before the numbers of a further line.
    const fn margin(self) -> usize {
        if self.version < 3 { 3 } else { 4 }
    }

    /// The name of the satellite that sent the ephemeris that begins with a line, where files give its system by a
    /// letter; `None` for Galileo and BeiDou, of which other messages are read.
    pub(super) fn sender(self, line: &Line<'_>) -> Option<[u8; 3]> {
        let from = match self.version {
            ..3 => return None,
            3 => 0,
            _ if line.bytes.starts_with(b"> EPH ") => 6,
            _ => return None,
        };
        let name = [0, 1, 2].map(|place| line.column(from + place));
        let is_read = satellite(&name).is_some_and(has_orbit);
        (name[0] == b'G' || !is_read).then_some(name)
    }

    fn satellite(self, line: &Line<'_>) -> Option<u8> {
        match self.system {
            Some(b'E') => satellite(&[b"E", line.columns(0, 2)].concat()),
            Some(_) => satellite(line.columns(0, 2)),
            None if self.version < 3 => None,
            None => satellite(line.columns(0, 3)).filter(|number| has_orbit(*number)),
        }
    }
}

/// Whether a satellite broadcasts its orbit as an ellipse: GLONASS broadcasts a position and a velocity, and the orbit
/// of a geostationary satellite is given in a rotated frame.
const fn has_orbit(satellite: u8) -> bool {
    !matches!(System::of(satellite), System::Glonass) && !System::is_geostationary(satellite)
}

/// The numbers of a record.
#[derive(Debug)]
pub(super) struct Numbers<'a> {
    /// The line that identifies the record.
    first: Line<'a>,
    lines: Vec<Line<'a>>,
    layout: Layout,
}

impl Numbers<'_> {
    /// The time in the first line of numbers.
    pub(super) fn time(&self) -> Result<GpsTime, Error> {
        let line = self.lines.first().unwrap_or(&self.first);
        if self.layout.version < 3 {
            line.short_time([3, 6, 9, 12, 15, 17, 22], full_year)
        } else {
            line.time([4, 8, 11, 14, 17, 20, 23])
        }
    }

    /// A number by its index in the record; `None` if the field is blank.
    pub(super) fn optional(&self, place: usize) -> Result<Option<f64>, Error> {
        let margin = self.layout.margin();
        let (line, column) = match place.checked_sub(FIRST) {
            None => (0, margin + WIDTH + place * WIDTH),
            Some(rest) => (1 + rest / FURTHER, margin + rest % FURTHER * WIDTH),
        };
        let Some(line) = self.lines.get(line) else { return Ok(None) };
        line.optional_number("a number of a navigation message", column, column + WIDTH)
    }

    /// A required number by its index in the record.
    pub(super) fn needed(&self, place: usize) -> Result<f64, Error> {
        let complaint = || self.first.expected("a whole navigation message");
        self.optional(place)?.ok_or_else(complaint)
    }

    /// The coefficients α and β of Klobuchar's model.
    pub(super) fn ionosphere(&self) -> Result<[[f64; 4]; 2], Error> {
        let mut both = [[0.0; 4]; 2];
        for (place, coefficient) in both.as_flattened_mut().iter_mut().enumerate() {
            *coefficient = self.needed(place)?;
        }
        Ok(both)
    }
}

/// A record of a navigation file.
#[derive(Debug)]
pub(super) enum Record<'a> {
    /// The ephemeris of a satellite: its number, its message if that is given, and the numbers.
    Ephemeris(u8, Option<Message>, Numbers<'a>),
    /// The coefficients of Klobuchar's model.
    Ionosphere(Numbers<'a>),
    /// A record that is not used.
    Other,
}

impl<'a> Record<'a> {
    /// Reads the record that begins with a line; `lines` continue after it.
    pub(super) fn of(first: Line<'a>, layout: Layout, lines: &mut Lines<'a>) -> Self {
        if layout.version >= 4 {
            let lines = rest(None, lines, |line| line.column(0) != b'>');
            return Self::of_version_4(Numbers { first, lines, layout });
        }
        let lines = rest(Some(first), lines, |line| line.columns(0, 2).is_empty());
        match layout.satellite(&first) {
            Some(number) => Self::Ephemeris(number, None, Numbers { first, lines, layout }),
            None => Self::Other,
        }
    }

    fn of_version_4(numbers: Numbers<'a>) -> Self {
        let mut words = blank_separated(numbers.first.bytes).skip(1);
        let mut word = || words.next().unwrap_or_default();
        let (kind, name, message) = (word(), word(), word());
        let message = match (name.first(), message) {
            (Some(b'G'), b"LNAV") => Message::Lnav,
            (Some(b'E'), b"INAV") => Message::Inav,
            (Some(b'E'), b"FNAV") => Message::Fnav,
            (Some(b'C'), b"D1") => Message::D1,
            _ => return Self::Other,
        };
        match (kind, satellite(name).filter(|number| has_orbit(*number))) {
            (b"EPH", Some(number)) => Self::Ephemeris(number, Some(message), numbers),
            (b"ION", _) if message == Message::Lnav => Self::Ionosphere(numbers),
            _ => Self::Other,
        }
    }
}

/// The first line, if given, and the following lines as long as they `belong` to the record; excess lines are skipped.
fn rest<'a>(
    first: Option<Line<'a>>,
    lines: &mut Lines<'a>,
    belongs: impl Fn(&Line<'a>) -> bool,
) -> Vec<Line<'a>> {
    let mut record: Vec<_> = first.into_iter().collect();
    let mut ahead = lines.clone();
    while let Some(line) = ahead.next().filter(&belongs) {
        if record.len() < LINES {
            record.push(line);
        }
        *lines = ahead.clone();
    }
    record
}
