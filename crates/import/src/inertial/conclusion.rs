//! Conclusions about a log, and the evidence for them.

use std::fmt;

use crate::formats::Format;

/// The evidence for a conclusion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Source {
    /// The header, or the names of the columns.
    Header,
    /// The data.
    Data,
    /// An option.
    Option,
    /// The definition of the log's format.
    Format(Format),
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Header => f.write_str("header"),
            Self::Data => f.write_str("from the data"),
            Self::Option => f.write_str("option"),
            Self::Format(format) => format.fmt(f),
        }
    }
}

/// A conclusion about a log; displayed as one line such as `time in ms, acceleration in g: header`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Conclusion {
    /// What was concluded.
    pub what: String,
    /// The evidence for it.
    pub from: Source,
}

impl fmt::Display for Conclusion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.what, self.from)
    }
}

/// Joins conclusions from the same source into one line.
pub(crate) fn conclusions(parts: impl IntoIterator<Item = (String, Source)>) -> Vec<Conclusion> {
    let mut conclusions: Vec<Conclusion> = Vec::new();
    for (what, from) in parts {
        match conclusions.iter_mut().find(|known| known.from == from) {
            Some(known) => known.what = format!("{}, {what}", known.what),
            None => conclusions.push(Conclusion { what, from }),
        }
    }
    conclusions
}
