//! Recorded flights, with the truth where it is known, and synthetic ones by name.

pub mod area;
pub mod flight;
pub mod plane;
pub mod truth;
mod users;

use std::path::PathBuf;

use kestirim_replay::drone::Area;

use self::flight::Flight;
use self::truth::Truth;
use crate::Error;
use crate::system::Files;
use crate::table::Found;

/// The minimum number of measurements for an estimate of the position.
pub const FEWEST_STOPS: usize = 3;

/// A recording of a flight.
#[derive(Debug, Clone)]
pub enum Recording {
    /// A recorded flight.
    Flight(Box<Recorded>),
    /// A synthetic user who walks in a circle, followed by the drone.
    Moving,
    /// A synthetic user who is stationary.
    Staying,
}

/// A recorded flight and its related files.
#[derive(Debug, Clone)]
pub struct Recorded {
    /// The path of the log.
    pub log: PathBuf,
    /// The measurements: at least three.
    pub flight: Flight,
    /// The area in which the user can be.
    pub area: Option<Box<Area>>,
    /// The true positions of the users.
    pub truth: Truth,
    /// How the log was read.
    pub found: Found,
}

impl Recording {
    /// Reads the files of a recording.
    ///
    /// # Errors
    /// An error that names the file, the line, and what was expected there; [`Error::File`] if there are too few
    /// measurements.
    pub fn read(files: &Files) -> Result<Self, Error> {
        let log = files.required("log")?;
        let (flight, found) = flight::read(log, files.reading.tables()?)?;
        let truth = files.one("truth").map(|path| Truth::read(path, flight.origin)).transpose()?;
        let truth = truth.unwrap_or_default();
        let area = files.one("area").map(|path| area::read(path, flight.origin)).transpose()?;
        let recorded = Recorded { log: log.to_path_buf(), flight, area, truth, found };
        if recorded.flight.stops.len() < FEWEST_STOPS {
            return Err(recorded.refused(
                "expected at least three measurements within ±300 dB, from above the ground",
            ));
        }
        Ok(Self::Flight(Box::new(recorded)))
    }

    /// A synthetic recording by name.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is none of that name.
    pub fn synthetic(name: &str) -> Result<Self, Error> {
        match name {
            "moving" => Ok(Self::Moving),
            "staying" => Ok(Self::Staying),
            _ => Err(Error::Usage(format!("there is no synthetic flight {name:?}"))),
        }
    }
}

impl Recorded {
    /// An error about the log.
    pub(super) fn refused(&self, problem: &str) -> Error {
        Error::File { path: self.log.clone(), problem: problem.to_owned() }
    }
}
