//! Reference recordings of a system: where they lie below a folder of data, and which numbers are reported for them.

use std::path::Path;

use crate::Error;

/// Recordings of one kind, and the numbers reported for them.
#[derive(Debug, Clone, Copy)]
pub struct Study {
    /// The identifier of its table and figures: lower case, with hyphens.
    pub id: &'static str,
    /// What was recorded.
    pub title: &'static str,
    /// The origin of the recordings, and what a reader should know about the numbers.
    pub note: &'static str,
    /// The recordings, in the order in which they are shown.
    pub recordings: &'static [Recorded],
    /// The numbers reported for each recording, and for all together.
    pub measures: &'static [Measure],
    /// The names of the page's figures that are shown for each recording.
    pub figures: &'static [&'static str],
}

/// A recording as a command line would name it.
#[derive(Debug, Clone, Copy)]
pub struct Recorded {
    /// The name of the recording, in one or a few words.
    pub name: &'static str,
    /// The method: [`OURS`](Self::OURS) or [`THEIRS`](Self::THEIRS).
    pub method: &'static str,
    /// The fields of the recording with their files.
    pub files: &'static [(&'static str, DataFile)],
    /// The settings, as on the command line.
    pub settings: &'static [(&'static str, &'static str)],
}

/// A file of a recording.
#[derive(Debug, Clone, Copy)]
pub enum DataFile {
    /// A file at this path below the folder of data.
    There(&'static str),
    /// A file that is made from others.
    Made(Making),
}

/// How a file is made from files of the folder of data.
#[derive(Debug, Clone, Copy)]
pub struct Making {
    /// The name of the file.
    pub name: &'static str,
    /// The paths below the folder of data that it is made from.
    pub of: &'static [&'static str],
    /// How it is made, in words or as a command.
    pub how: &'static str,
    /// Makes the file from those below the first path, at the second path.
    pub make: fn(&Path, &Path) -> Result<(), Error>,
}

/// A number that a replay prints.
#[derive(Debug, Clone, Copy)]
pub struct Measure {
    /// The quantity that is measured.
    pub quantity: &'static str,
    /// The unit; empty for a dimensionless number.
    pub unit: &'static str,
    /// A JSON pointer to the number in the output of `replay --json`.
    pub at: &'static str,
    /// The factor from the printed number to this unit.
    pub scale: f64,
    /// How several recordings are combined, and reference values for the result; empty if the number is reported for
    /// each recording alone.
    pub together: &'static [Together],
}

/// A number that combines several recordings.
#[derive(Debug, Clone, Copy)]
pub struct Together {
    /// The way in which they are combined.
    pub over: Over,
    /// The number printed in a paper, or the best that another program reaches on these recordings.
    pub known: Option<f64>,
    /// The theoretical bound, or the requirement.
    pub limit: Option<f64>,
}

/// How the magnitudes of a number of several recordings are combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    /// A single recording.
    One,
    /// The mean.
    Mean,
    /// The median.
    Median,
    /// The largest.
    Worst,
}

impl Study {
    /// The number of recordings tracked by this library's method.
    pub fn count(&self) -> usize {
        self.recordings.iter().filter(|it| it.is_ours()).count()
    }
}

impl Recorded {
    /// The name of this library's own method.
    pub const OURS: &'static str = "default";
    /// The name of the paper's own method, as run here.
    pub const THEIRS: &'static str = "published method";

    /// A recording to be tracked by this library's method, with files of the folder of data and settings.
    pub const fn new(
        name: &'static str,
        files: &'static [(&'static str, DataFile)],
        settings: &'static [(&'static str, &'static str)],
    ) -> Self {
        Self { name, method: Self::OURS, files, settings }
    }

    /// Marks the recording as tracked by the paper's own method.
    #[must_use]
    pub const fn published(mut self) -> Self {
        self.method = Self::THEIRS;
        self
    }

    /// Whether it is tracked by this library's own method.
    pub fn is_ours(&self) -> bool {
        self.method == Self::OURS
    }

    /// The name, followed by the method if that is not this library's.
    pub fn title(&self) -> String {
        if self.is_ours() {
            self.name.to_owned()
        } else {
            format!("{}, {}", self.name, self.method)
        }
    }

    /// The paths below the folder of data that the recording requires.
    pub fn needs(&self) -> impl Iterator<Item = &'static str> {
        let paths = self.files.iter().flat_map(|(_, file)| match file {
            DataFile::There(path) => std::slice::from_ref(path),
            DataFile::Made(making) => making.of,
        });
        paths.copied()
    }

    /// A description of how each file that is made from others is made.
    pub fn made(&self) -> impl Iterator<Item = String> {
        self.files.iter().filter_map(|(_, file)| match file {
            DataFile::Made(making) => Some(format!("{}: {}", making.name, making.how)),
            DataFile::There(_) => None,
        })
    }
}

impl Measure {
    /// A number reported for each recording, in the unit in which it is printed.
    pub const fn new(quantity: &'static str, unit: &'static str, at: &'static str) -> Self {
        Self { quantity, unit, at, scale: 1.0, together: &[] }
    }

    /// Sets the factor from the printed number to this unit.
    #[must_use]
    pub const fn times(mut self, scale: f64) -> Self {
        self.scale = scale;
        self
    }

    /// Reports the number for all recordings together as well.
    #[must_use]
    pub const fn together(mut self, together: &'static [Together]) -> Self {
        self.together = together;
        self
    }
}

impl Together {
    /// A combined number without reference values.
    pub const fn new(over: Over) -> Self {
        Self { over, known: None, limit: None }
    }

    /// Sets the number printed in a paper, or the best that another program reaches.
    #[must_use]
    pub const fn known(mut self, known: f64) -> Self {
        self.known = Some(known);
        self
    }

    /// Sets the theoretical bound, or the requirement.
    #[must_use]
    pub const fn limit(mut self, limit: f64) -> Self {
        self.limit = Some(limit);
        self
    }
}

impl Over {
    /// The name of a quantity combined over `count` recordings.
    pub fn of(self, quantity: &str, count: usize) -> String {
        match self {
            Self::One => quantity.to_owned(),
            Self::Mean => format!("{quantity}, mean of {count}"),
            Self::Median => format!("{quantity}, median of {count}"),
            Self::Worst => format!("{quantity}, worst of {count}"),
        }
    }
}
