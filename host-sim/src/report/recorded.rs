//! The results of recordings, beside a chapter's synthetic streams.

use serde::Serialize;

use super::{Comparison, Value};
use crate::figure::Figure;

/// The recorded part of a chapter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Recorded {
    /// The folder of data, as the command line names it.
    pub folder: String,
    /// Recordings that are not shown, and why.
    pub left_out: Vec<String>,
    /// The recordings, grouped by kind.
    pub studies: Vec<Studied>,
}

/// Recordings of one kind.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Studied {
    /// The results of all recordings together.
    pub table: Comparison,
    /// The command that reproduces the table.
    pub command: String,
    /// The quantities reported for each recording, with units.
    pub quantities: Vec<String>,
    /// The results of each recording.
    pub replays: Vec<Replayed>,
}

/// A recording and its results.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Replayed {
    /// The name of the recording.
    pub name: String,
    /// A number for each of the quantities.
    pub values: Vec<Value>,
    /// Whether the estimate can be relied upon, in words.
    pub health: String,
    /// The commands that reproduce the result, in order.
    pub commands: Vec<String>,
    /// A selection of the figures that the explorer shows of the recording.
    #[serde(skip)]
    pub figures: Vec<Figure>,
}

impl Recorded {
    /// Each number with the table that it belongs to and the command that reproduces it.
    pub(super) fn numbers(&self) -> impl Iterator<Item = (&str, &Value, &str)> {
        self.studies.iter().flat_map(|study| {
            let id = study.table.id.as_str();
            let together = study.table.values.iter();
            let together = together.map(move |value| (id, value, study.command.as_str()));
            let each = study.replays.iter().flat_map(move |replay| {
                let command = replay.commands.last().map_or("", String::as_str);
                replay.values.iter().map(move |value| (id, value, command))
            });
            together.chain(each)
        })
    }

    /// The figures of all recordings.
    pub(super) fn figures(&self) -> impl Iterator<Item = &Figure> {
        let replays = self.studies.iter().flat_map(|study| &study.replays);
        replays.flat_map(|replay| &replay.figures)
    }
}
