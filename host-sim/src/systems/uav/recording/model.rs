//! The model of an aircraft from a file.

use std::path::Path;

use kestirim_replay::uav::{Model, ModelFile};
use serde_json::{Map, Value};

use crate::text::TextFile;
use crate::{Error, output};

/// What is in a file.
///
/// # Errors
/// The file, the line, and what was expected there.
pub fn read(path: &Path) -> Result<Model, Error> {
    let file = TextFile::read(path)?;
    let expected =
        "a JSON object with A, B and perhaps C, outputs, trim and h, or with airframe and airspeed";
    let contents: ModelFile = file.json(expected)?;
    let all: Map<String, Value> = file.json(expected)?;
    let unknown: Vec<_> =
        all.keys().filter(|name| !ModelFile::FIELDS.contains(&name.as_str())).cloned().collect();
    if !unknown.is_empty() {
        output::warn_of(path, &[format!("not used: {}", unknown.join(", "))]);
    }
    contents.model().map_err(|error| file.error(error.to_string()))
}
