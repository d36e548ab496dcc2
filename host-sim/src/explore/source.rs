use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::Explorer;
use crate::Error;

/// Where a system's explorer gets recordings from.
#[derive(Debug, Clone, Copy)]
pub struct Source {
    /// The system's name on the command line.
    pub system: &'static str,
    /// What it does, in a few words.
    pub title: &'static str,
    /// The files that make a recording.
    pub files: &'static [FileField],
    /// Synthetic recordings that need no file: name and what people call it, the default first.
    pub bundled: &'static [(&'static str, &'static str)],
    /// Opens a recording.
    pub open: fn(&Files) -> Result<Box<dyn Explorer>, Error>,
    /// Opens a synthetic recording by name.
    pub open_bundled: fn(&str) -> Result<Box<dyn Explorer>, Error>,
}

/// A file that belongs to a recording.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct FileField {
    /// Its name, as on the command line: `log` is `--log`.
    pub name: &'static str,
    /// What it holds, with its columns.
    pub label: &'static str,
    /// Whether there is no recording without it.
    pub required: bool,
    /// Whether there may be more than one.
    pub several: bool,
}

/// Where the files of a recording lie, by the names of their fields.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Files(BTreeMap<String, Vec<PathBuf>>);

impl Files {
    /// Adds a file.
    pub fn add(&mut self, field: impl Into<String>, path: impl Into<PathBuf>) {
        self.0.entry(field.into()).or_default().push(path.into());
    }

    /// The file of a field, if there is one.
    pub fn one(&self, field: &str) -> Option<&Path> {
        self.all(field).first().map(PathBuf::as_path)
    }

    /// All files of a field.
    pub fn all(&self, field: &str) -> &[PathBuf] {
        self.0.get(field).map_or(&[], Vec::as_slice)
    }

    /// The file of a field that must be there.
    ///
    /// # Errors
    /// [`Error::Usage`] if it is not.
    pub fn required(&self, field: &str) -> Result<&Path, Error> {
        self.one(field).ok_or_else(|| Error::Usage(format!("a file is needed: {field}")))
    }
}
