use std::io;
use std::path::{Path, PathBuf};

use crate::text::printable_path;

/// The reason why a command failed: one plain sentence, reported with exit status 2.
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
        /// The operating system's error.
        source: io::Error,
    },

    /// The contents of a file as a whole are not as expected.
    #[error("{}: {problem}", printable_path(.path))]
    File {
        /// The file, as named by the user.
        path: PathBuf,
        /// What was found and what was expected.
        problem: String,
    },

    /// A line of a file is not as expected.
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
        /// The operating system's error.
        source: io::Error,
    },

    /// An error of a sweep: its shards, plans or tables.
    #[error(transparent)]
    Sweep(#[from] kestirim_sweep::Error),

    /// Standard output cannot be written, for a reason other than a reader that has closed the pipe.
    #[error("standard output cannot be written: {0}")]
    Stdout(#[source] io::Error),
}

impl Error {
    /// Shortens the paths of files below `folder` to their file names, so that an uploaded file is named as uploaded,
    /// not by where it is stored.
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
