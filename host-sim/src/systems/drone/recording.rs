//! A flight as it was recorded, with the truth where that is known, or a synthetic one by name.

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

/// Of fewer measurements a place says nothing.
pub const FEWEST_STOPS: usize = 3;

/// A recording.
#[derive(Debug, Clone)]
pub enum Recording {
    /// A recorded flight.
    Flight(Box<Recorded>),
    /// A synthetic user who walks a circle, followed by the drone.
    Moving,
    /// A synthetic user who stays.
    Staying,
}

/// A recorded flight.
#[derive(Debug, Clone)]
pub struct Recorded {
    /// Where it was read.
    pub log: PathBuf,
    /// What was measured: at least three times.
    pub flight: Flight,
    /// Where the user can be.
    pub area: Option<Box<Area>>,
    /// Where users really are.
    pub truth: Truth,
    /// How the log was read.
    pub found: Found,
}

impl Recording {
    /// Reads the files.
    ///
    /// # Errors
    /// The file, the line, and what was expected there; [`Error::File`] if there is too little.
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

    /// A synthetic one.
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
    /// A complaint about the log.
    pub(super) fn refused(&self, problem: &str) -> Error {
        Error::File { path: self.log.clone(), problem: problem.to_owned() }
    }
}
