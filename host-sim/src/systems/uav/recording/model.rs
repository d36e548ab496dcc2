//! The model of an aircraft from a file.

use std::path::Path;

use kestirim_replay::uav::{Model, ModelFile};

use crate::Error;
use crate::text::TextFile;

/// What is in a file.
///
/// # Errors
/// The file, the line, and what was expected there.
pub fn read(path: &Path) -> Result<Model, Error> {
    let file = TextFile::read(path)?;
    let contents: ModelFile =
        file.json("a JSON object with A, B and perhaps C, outputs, trim and h")?;
    contents.model().map_err(|error| file.error(error.to_string()))
}
