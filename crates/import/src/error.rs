//! Errors of reading a log, each one sentence on one line.

use crate::part::Part;

/// Why a log is refused: one sentence that says what was expected and what was found. It names the line; the caller, who
/// knows the file's name, puts that before it.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The log as a whole is not what it should be.
    #[error("{problem}")]
    Log {
        /// What was expected and what was found.
        problem: String,
    },
    /// A line is not what it should be.
    #[error("line {line}: {problem}")]
    Line {
        /// The line, from 1.
        line: usize,
        /// What was expected and what was found.
        problem: String,
    },
    /// A record, or a line of one of several texts, is not what it should be.
    #[error("{}: {problem}", part.place(&[*number], false))]
    Part {
        /// What it is: a record, or a line of a certain text.
        part: Part,
        /// The number of the record or line, from 1.
        number: usize,
        /// What was expected and what was found.
        problem: String,
    },
    /// More of the log is damaged than may be skipped.
    #[error(
        "expected at most {allowed} damaged {} of {rows}, found {found}; the first is {first}",
        first.part.noun(2)
    )]
    Damaged {
        /// The number of lines or records that may be skipped.
        allowed: usize,
        /// The number of lines or records that should be samples.
        rows: usize,
        /// The number of damaged lines or records.
        found: usize,
        /// The first damaged one, and what is wrong with it.
        first: Complaint,
    },
    /// The log does not say what is needed, or contradicts itself.
    #[error("{problem}; {option} decides")]
    Undecided {
        /// What was expected and what was found.
        problem: String,
        /// The option that settles it, such as `--units gyro=deg/s`.
        option: String,
    },
    /// An option is malformed.
    #[error("{problem}")]
    Options {
        /// What was expected and what was found.
        problem: String,
    },
}

/// A line or record, and what is wrong with it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Complaint {
    /// Whether it is a line or a record.
    pub part: Part,
    /// The number of the line or record, from 1.
    pub line: usize,
    /// What was expected and what was found.
    pub problem: String,
}

impl std::fmt::Display for Complaint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.part.place(&[self.line], false), self.problem)
    }
}

impl From<Complaint> for Error {
    fn from(Complaint { part, line, problem }: Complaint) -> Self {
        match part {
            Part::Line => Self::Line { line, problem },
            part => Self::Part { part, number: line, problem },
        }
    }
}

impl Error {
    pub(crate) fn log(problem: impl Into<String>) -> Self {
        Self::Log { problem: problem.into() }
    }

    pub(crate) fn line(line: usize, problem: impl Into<String>) -> Self {
        Self::Line { line, problem: problem.into() }
    }

    pub(crate) fn undecided(problem: impl Into<String>, option: impl Into<String>) -> Self {
        Self::Undecided { problem: problem.into(), option: option.into() }
    }

    pub(crate) fn options(problem: impl Into<String>) -> Self {
        Self::Options { problem: problem.into() }
    }
}

/// An excerpt of a log in quotation marks, on one line and shortened.
pub(crate) fn quoted(text: &str) -> String {
    const LONGEST: usize = 24;
    let text = text.trim();
    if text.is_empty() {
        return "nothing".to_owned();
    }
    let start: String = text.chars().take(LONGEST).collect();
    let dots = if text.chars().nth(LONGEST).is_some() { "…" } else { "" };
    format!("\"{}{dots}\"", start.escape_debug())
}

/// A list of names from a log, on one line and shortened; `none` if it is empty.
pub(crate) fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    const MOST: usize = 12;
    let mut list = String::new();
    for (place, name) in names.into_iter().enumerate() {
        let separator = if place == 0 { "" } else { ", " };
        if place == MOST {
            list.push_str(", …");
            break;
        }
        list.push_str(separator);
        list.extend(
            name.chars().take(60).map(|letter| if letter.is_control() { '?' } else { letter }),
        );
    }
    if list.is_empty() { "none".to_owned() } else { list }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_stays_on_one_short_line() {
        assert_eq!(quoted("a\nb\0"), r#""a\nb\0""#);
        assert_eq!(quoted(&"x".repeat(1000)).chars().count(), 27);
        assert_eq!(quoted(" "), "nothing");
        let problem = "expected 7 fields, found 6".to_owned();
        let first = Complaint { part: Part::Line, line: 7, problem };
        let error = Error::Damaged { allowed: 3, rows: 10, found: 4, first };
        assert_eq!(
            error.to_string(),
            "expected at most 3 damaged lines of 10, found 4; the first is line 7: expected 7 fields, found 6"
        );
    }
}
