//! Observations: RINEX 2.x, 3.0x and 4.0x.

mod body;
mod header;
mod signals;

use std::collections::BTreeMap;
use std::path::Path;

use kestirim_gnss_ppp::GpsTime;

use self::body::Body;
use self::header::Header;
pub use self::signals::{Signal, Signals};
use super::lines::Text;
use crate::Error;

/// What a receiver observed of GPS satellites.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Observations {
    /// The station's name.
    pub marker: String,
    /// The receiver's type.
    pub receiver: String,
    /// Type and radome of the antenna in 20 columns, as an ANTEX file names it.
    pub antenna: String,
    /// Where the marker is, to some metres: ECEF, m.
    pub approximate_position: Option<[f64; 3]>,
    /// The antenna's reference point above, east and north of the marker, m.
    pub antenna_delta_hen: [f64; 3],
    /// In the order of time.
    pub epochs: Vec<Epoch>,
    /// What was taken from each satellite's signals, by its number.
    pub signals: BTreeMap<u8, Signals>,
    /// What a user should know of the file.
    pub warnings: Vec<String>,
}

/// Observations of one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Epoch {
    /// By the receiver's clock.
    pub time: GpsTime,
    /// The receiver was without power since the epoch before.
    pub power_failure: bool,
    /// In the order of the file.
    pub satellites: Vec<Observed>,
}

/// Observations of one satellite, on L1 and L2.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Observed {
    /// The satellite.
    pub prn: u8,
    /// Pseudoranges, m.
    pub code: [Option<f64>; 2],
    /// Carrier phases, cycles.
    pub phase: [Option<f64>; 2],
    /// The receiver lost the phase since the epoch before.
    pub loss_of_lock: [bool; 2],
}

impl Observations {
    /// Reads a file.
    ///
    /// # Errors
    /// The file, the line, and what was expected there.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Self::parse(&Text::read(path)?)
    }

    /// Reads a file in memory.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(text: &Text) -> Result<Self, Error> {
        let mut lines = text.lines();
        let header = Header::parse(text, &mut lines)?;
        let mut body = Body::new(header);
        body.read(text, &mut lines)?;
        Ok(body.finish(text))
    }
}

#[cfg(test)]
mod tests;
