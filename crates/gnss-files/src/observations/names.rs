//! Names of satellites.

use crate::error::Error;
use crate::system;
use crate::system::{System, gps_satellite};
use crate::text::{Line, Lines};

/// Reads the satellite names of a RINEX 2 epoch, twelve to a line.
pub(super) fn names<'a>(
    line: &Line<'a>,
    lines: &mut Lines<'a>,
    count: usize,
) -> Result<Vec<[u8; 3]>, Error> {
    let mut names = Vec::with_capacity(count.min(999));
    let mut line = *line;
    for i in 0..count {
        if i > 0 && i % 12 == 0 {
            line = lines.expect("further satellites of the epoch")?;
        }
        let column = 32 + 3 * (i % 12);
        let name = [0, 1, 2].map(|place| line.column(column + place));
        if satellite(name, true).is_none() {
            return Err(line.expected("the satellites of an epoch"));
        }
        names.push(name);
    }
    Ok(names)
}

/// The meaning of a satellite's name.
#[derive(Debug, Clone, Copy)]
pub(super) enum Named {
    /// A satellite of a system that is read, by its number.
    Known(u8),
    /// A satellite that is not read, by its name.
    Other([u8; 3]),
}

impl Named {
    /// The satellite system, if it is read.
    pub(super) fn system(self) -> Option<System> {
        match self {
            Self::Known(number) => Some(System::of(number)),
            Self::Other(_) => None,
        }
    }
}

/// The satellite of a name; `None` if it is no satellite's name. The observables of RINEX 2, which are the same for all
/// systems, are taken as those of GPS, so its other satellites are not read.
pub(super) fn satellite(name: [u8; 3], old: bool) -> Option<Named> {
    match name {
        [b'G' | b' ', ..] => gps_satellite(&name).map(Named::Known),
        [b'A'..=b'Z', b'0'..=b'9' | b' ', b'0'..=b'9'] => {
            // A number that no satellite of a known system has is passed over, too.
            let known = system::satellite(&name).filter(|_| !old);
            Some(known.map_or(Named::Other(name), Named::Known))
        }
        _ => None,
    }
}
