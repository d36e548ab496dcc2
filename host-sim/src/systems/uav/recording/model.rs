//! Files of aircraft models.

use std::path::Path;

use kestirim_replay::uav::{Model, ModelFile};

use crate::text::{TextFile, printable_path};
use crate::{Error, output};

/// Reads a model.
///
/// # Errors
/// [`Error::Usage`] if there is no such file; otherwise an error that names the file, the line, and what was expected
/// there.
pub fn read(path: &Path) -> Result<Model, Error> {
    if !path.exists() {
        return Err(Error::Usage(format!(
            "--model: expected P1, P2, P3 or a file, found {}",
            printable_path(path)
        )));
    }
    let file = TextFile::read(path)?;
    let expected = "a JSON object with A, B and perhaps C, outputs, trim and h, or with airframe and airspeed, or with a grid";
    let (contents, unused) = file.json_with_unused::<ModelFile>(expected)?;
    if !unused.is_empty() {
        output::warn_of(path, &[format!("not used: {}", unused.join(", "))]);
    }
    contents.model().map_err(|error| file.error(error.to_string()))
}
