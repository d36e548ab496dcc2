//! What a log is made of, and its damage is counted in.

/// What a log is made of.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Part {
    /// Lines of a text.
    #[default]
    Line,
    /// Lines of one of the texts in a file, by its name.
    LineOf(&'static str),
    /// Records of a file that is no text.
    Record,
}

impl Part {
    /// One of them, or several.
    pub(crate) fn noun(self, count: usize) -> &'static str {
        match (self, count) {
            (Self::Record, 1) => "record",
            (Self::Record, _) => "records",
            (_, 1) => "line",
            (_, _) => "lines",
        }
    }

    /// Where something stands: `line 7`, `lines 7, 8 of Gyroscope.csv`, `record 9`.
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

    /// The one before.
    pub(crate) fn before(self) -> &'static str {
        match self {
            Self::Record => "the record before",
            _ => "the line above",
        }
    }
}
