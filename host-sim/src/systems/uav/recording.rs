//! Recorded and synthetic flights.

pub mod log;
pub mod model;

use std::path::PathBuf;

use kestirim_replay::uav::{Log, Model, STATE_COLUMNS, Truth};

use super::simulate::scenario::Inputs;
use crate::Error;
use crate::system::Files;
use crate::table::Found;

/// A flight.
#[derive(Debug, Clone, PartialEq)]
pub enum Recording {
    /// A flight from files.
    Logged(Box<Logged>),
    /// A flight simulated according to the settings, with these inputs.
    Synthetic(Inputs),
}

/// The contents of the files of a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Logged {
    /// The path of the log.
    pub path: PathBuf,
    /// The model from a file; `None` for a known aircraft, selected in the settings.
    pub model: Option<Model>,
    /// The log, in its own coordinates.
    pub log: Log,
    /// The true states, if known.
    pub truth: Option<Truth>,
    /// How the log was read.
    pub found: Found,
}

impl Recording {
    /// Reads all files.
    ///
    /// # Errors
    /// An error that names the file, the line, and what was expected there.
    pub fn read(files: &Files) -> Result<Self, Error> {
        let path = files.required("log")?.to_path_buf();
        let model = files.one("model").map(model::read).transpose()?;
        let names = model.as_ref().map_or_else(
            || STATE_COLUMNS.to_vec(),
            |model| model.outputs.iter().map(|(name, _)| name.as_str()).collect(),
        );
        let (log, found) = log::read(&path, &names, files.reading.tables()?)?;
        let truth = files.one("truth").map(log::read_truth).transpose()?;
        Ok(Self::Logged(Box::new(Logged { path, model, log, truth, found })))
    }

    /// A synthetic flight by name.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is none of that name.
    pub fn synthetic(name: &str) -> Result<Self, Error> {
        match name {
            "constant" => Ok(Self::Synthetic(Inputs::Constant)),
            "sine" => Ok(Self::Synthetic(Inputs::Sine)),
            _ => Err(Error::Usage(format!("there is no synthetic flight {name:?}"))),
        }
    }

    /// The error that no estimator can follow the recording.
    pub(super) fn refused(&self, problem: String) -> Error {
        match self {
            Self::Logged(logged) => Error::File { path: logged.path.clone(), problem },
            Self::Synthetic(_) => Error::Usage(problem),
        }
    }
}
