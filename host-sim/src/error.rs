use std::io;
use std::path::{Path, PathBuf};

use crate::text::printable_path;

/// Why a command could not be carried out: one plain sentence, and exit status 2.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The command line asks for something that does not exist or does not fit.
    #[error("{0}")]
    Usage(String),

    /// A file cannot be opened or read.
    #[error("{}: cannot be read: {source}", printable_path(.path))]
    Read {
        /// The file, as named by the user.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },

    /// A file as a whole is not what it should be.
    #[error("{}: {problem}", printable_path(.path))]
    File {
        /// The file, as named by the user.
        path: PathBuf,
        /// What was found and what was expected.
        problem: String,
    },

    /// A line of a file is not what it should be.
    #[error("{}, line {line}: {problem}", printable_path(.path))]
    Line {
        /// The file, as named by the user.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// What was found and what was expected.
        problem: String,
    },

    /// A file cannot be written.
    #[error("{}: cannot be written: {source}", printable_path(.path))]
    Write {
        /// The file, as named by the user.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },

    /// Shards, plans and tables.
    #[error(transparent)]
    Sweep(#[from] kestirim_sweep::Error),

    /// Standard output cannot be written, for a reason other than a reader that went away.
    #[error("standard output cannot be written: {0}")]
    Stdout(#[source] io::Error),
}

impl Error {
    /// With files below `folder` named by their last part: what an uploaded file is called, not where it lies.
    pub fn naming_files_below(mut self, folder: &Path) -> Self {
        match &mut self {
            Self::Read { path, .. }
            | Self::File { path, .. }
            | Self::Line { path, .. }
            | Self::Write { path, .. }
                if path.starts_with(folder) =>
            {
                *path = path.file_name().map(PathBuf::from).unwrap_or_default();
            }
            _ => {}
        }
        self
    }
}
