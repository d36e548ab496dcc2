//! The parts that a log consists of, in which its damage is counted.

/// The kind of part that a log consists of.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Part {
    /// Lines of a text file.
    #[default]
    Line,
    /// Lines of one of several texts in a file, which is named.
    LineOf(&'static str),
    /// Records of a binary file.
    Record,
}

impl Part {
    /// The noun for `count` of these parts, in the singular or plural.
    pub(crate) fn noun(self, count: usize) -> &'static str {
        match (self, count) {
            (Self::Record, 1) => "record",
            (Self::Record, _) => "records",
            (_, 1) => "line",
            (_, _) => "lines",
        }
    }

    /// The position of parts, in words: `line 7`, `lines 7, 8 of Gyroscope.csv`, `record 9`.
    pub(crate) fn place(self, numbers: &[usize], more: bool) -> String {
        let list: Vec<_> = numbers.iter().map(usize::to_string).collect();
        let dots = if more { ", …" } else { "" };
        let count = if more { 2 } else { numbers.len() };
        let place = format!("{} {}{dots}", self.noun(count), list.join(", "));
        match self {
            Self::LineOf(file) => format!("{place} of {file}"),
            _ => place,
        }
    }

    /// The phrase for the preceding part.
    pub(crate) fn before(self) -> &'static str {
        match self {
            Self::Record => "the record before",
            _ => "the line above",
        }
    }
}
