//! Errors and warnings, one sentence each.

use std::path::{Path, PathBuf};
use std::{error, fmt, io};

/// The reason why a file cannot be read.
///
/// Displayed as one sentence on one line, such as
/// `day.rnx, line 18: expected an observation, found "2200x001.000"`.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// The file cannot be opened or read.
    Read {
        /// The file, as named by the caller.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// The file as a whole is not as expected: of another format, damaged, cut off in its header, or without data of a
    /// system that is read.
    File {
        /// The file, as named by the caller.
        path: PathBuf,
        /// What was expected, and what was found.
        problem: String,
    },
    /// A line is not as expected.
    Line {
        /// The file, as named by the caller.
        path: PathBuf,
        /// The line of the unpacked text, from 1. For Compact RINEX it is the line of the compressed text if that is
        /// damaged, and of the restored observations otherwise.
        line: usize,
        /// What was expected, and what was found.
        problem: String,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read { path, source } => {
                write!(f, "{}: cannot be read: {source}", one_line(path))
            }
            Self::File { path, problem } => write!(f, "{}: {problem}", one_line(path)),
            Self::Line { path, line, problem } => {
                write!(f, "{}, line {line}: {problem}", one_line(path))
            }
        }
    }
}

impl error::Error for Error {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match self {
            Self::Read { source, .. } => Some(source),
            Self::File { .. } | Self::Line { .. } => None,
        }
    }
}

/// Something in a file that a user should know, although the file could be read.
///
/// Displayed as one sentence on one line, like an [`Error`].
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Warning {
    /// The file, as named by the caller.
    pub path: PathBuf,
    /// The line of the unpacked text, from 1; `None` if the warning is about the file as a whole.
    pub line: Option<usize>,
    /// What was found, and how it was handled.
    pub problem: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, line, problem } = self;
        let path = one_line(path);
        match line {
            Some(line) => write!(f, "{path}, line {line}: {problem}"),
            None => write!(f, "{path}: {problem}"),
        }
    }
}

/// A path on one line, with control characters replaced.
fn one_line(path: &Path) -> String {
    path.display().to_string().replace(char::is_control, "?")
}

/// A short excerpt of a file in quotation marks, on one line.
pub(crate) fn quoted(bytes: &[u8]) -> String {
    const LONGEST: usize = 24;
    let text = String::from_utf8_lossy(bytes.trim_ascii());
    if text.is_empty() {
        return "nothing".to_owned();
    }
    let start: String = text.chars().take(LONGEST).collect();
    let dots = if text.chars().nth(LONGEST).is_some() { "…" } else { "" };
    format!("\"{}{dots}\"", start.escape_debug())
}

#[cfg(test)]
mod tests {
    use std::error::Error as _;

    use super::*;

    #[test]
    fn sentences_stay_on_one_line() {
        assert_eq!(quoted(b" a\nb\0 "), r#""a\nb\0""#);
        assert_eq!(quoted(&[b'x'; 1000]).chars().count(), 27);
        assert_eq!(quoted(b"  "), "nothing");
        let error = Error::Line { path: "a\nb".into(), line: 3, problem: "expected c".to_owned() };
        assert_eq!(error.to_string(), "a?b, line 3: expected c");
    }

    #[test]
    fn the_cause_is_kept() {
        let error =
            Error::Read { path: "f".into(), source: io::Error::from(io::ErrorKind::NotFound) };
        assert!(error.to_string().starts_with("f: cannot be read: "));
        assert!(error.source().is_some());
    }
}
