//! Recordings that stand for a system: where they lie below a folder of data, and which numbers are told of them.

use std::path::Path;

use crate::Error;

/// Recordings of one kind, and the numbers that are told of them.
#[derive(Debug, Clone, Copy)]
pub struct Study {
    /// Names its table and figures: lower case, with hyphens.
    pub id: &'static str,
    /// What was recorded.
    pub title: &'static str,
    /// Whose recordings they are, and what a reader should know of the numbers.
    pub note: &'static str,
    /// The recordings, in the order in which they are shown.
    pub recordings: &'static [Recorded],
    /// What is told of each, and of all together.
    pub measures: &'static [Measure],
    /// Names of the page's figures that are shown of each.
    pub figures: &'static [&'static str],
}

/// A recording as a command line would name it.
#[derive(Debug, Clone, Copy)]
pub struct Recorded {
    /// What it is called, in a word or a few.
    pub name: &'static str,
    /// [`OURS`](Self::OURS) or [`THEIRS`](Self::THEIRS).
    pub method: &'static str,
    /// Fields and their files.
    pub files: &'static [(&'static str, DataFile)],
    /// Settings as the command line says them.
    pub settings: &'static [(&'static str, &'static str)],
}

/// A file of a recording.
#[derive(Debug, Clone, Copy)]
pub enum DataFile {
    /// In the folder of data, below this path.
    There(&'static str),
    /// Made of what is there.
    Made(Making),
}

/// How a file is made of files of the folder of data.
#[derive(Debug, Clone, Copy)]
pub struct Making {
    /// Its name.
    pub name: &'static str,
    /// What it is made of: paths below the folder of data.
    pub of: &'static [&'static str],
    /// How, in words or as a command.
    pub how: &'static str,
    /// Makes it of the files below the first path, at the second.
    pub make: fn(&Path, &Path) -> Result<(), Error>,
}

/// A number that a replay prints.
#[derive(Debug, Clone, Copy)]
pub struct Measure {
    /// What is measured.
    pub quantity: &'static str,
    /// Its unit; empty for a bare number.
    pub unit: &'static str,
    /// Where it stands in what `replay --json` prints: a JSON pointer.
    pub at: &'static str,
    /// How many units one of that is.
    pub scale: f64,
    /// How several are put together, and what else is known of that; none: it is told of each recording alone.
    pub together: &'static [Together],
}

/// A number of several recordings.
#[derive(Debug, Clone, Copy)]
pub struct Together {
    /// How they are put together.
    pub over: Over,
    /// What a paper prints, or the best other program reaches on these recordings.
    pub known: Option<f64>,
    /// What nothing can be better than, or what was asked for.
    pub limit: Option<f64>,
}

/// How the magnitudes of a number of several recordings are put together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    /// There is one recording.
    One,
    /// Their mean.
    Mean,
    /// Their median.
    Median,
    /// The largest.
    Worst,
}

impl Study {
    /// How many recordings by this library's method it has.
    pub fn count(&self) -> usize {
        self.recordings.iter().filter(|it| it.is_ours()).count()
    }
}

impl Recorded {
    /// This library's own method.
    pub const OURS: &'static str = "default";
    /// The paper's own method, as it is run here.
    pub const THEIRS: &'static str = "published method";

    /// A recording that is tracked by this library's method, with files of the folder of data and settings.
    pub const fn new(
        name: &'static str,
        files: &'static [(&'static str, DataFile)],
        settings: &'static [(&'static str, &'static str)],
    ) -> Self {
        Self { name, method: Self::OURS, files, settings }
    }

    /// By the paper's own method.
    #[must_use]
    pub const fn published(mut self) -> Self {
        self.method = Self::THEIRS;
        self
    }

    /// Whether it is tracked by this library's own method.
    pub fn is_ours(&self) -> bool {
        self.method == Self::OURS
    }

    /// Its name, and that of the method if that is not this library's.
    pub fn title(&self) -> String {
        if self.is_ours() {
            self.name.to_owned()
        } else {
            format!("{}, {}", self.name, self.method)
        }
    }

    /// Paths below the folder of data without which there is no such recording.
    pub fn needs(&self) -> impl Iterator<Item = &'static str> {
        let paths = self.files.iter().flat_map(|(_, file)| match file {
            DataFile::There(path) => std::slice::from_ref(path),
            DataFile::Made(making) => making.of,
        });
        paths.copied()
    }

    /// How its files are made that are made of others.
    pub fn made(&self) -> impl Iterator<Item = String> {
        self.files.iter().filter_map(|(_, file)| match file {
            DataFile::Made(making) => Some(format!("{}: {}", making.name, making.how)),
            DataFile::There(_) => None,
        })
    }
}

impl Measure {
    /// A number that is told of each recording.
    pub const fn new(quantity: &'static str, unit: &'static str, at: &'static str) -> Self {
        Self { quantity, unit, at, scale: 1.0, together: &[] }
    }

    /// What is printed is in a unit that is so many of this one's.
    #[must_use]
    pub const fn times(mut self, scale: f64) -> Self {
        self.scale = scale;
        self
    }

    /// Told of all recordings together, too.
    #[must_use]
    pub const fn together(mut self, together: &'static [Together]) -> Self {
        self.together = together;
        self
    }
}

impl Together {
    /// Of which nothing else is known.
    pub const fn new(over: Over) -> Self {
        Self { over, known: None, limit: None }
    }

    /// With what a paper prints, or the best other program reaches.
    #[must_use]
    pub const fn known(mut self, known: f64) -> Self {
        self.known = Some(known);
        self
    }

    /// With what nothing can be better than, or what was asked for.
    #[must_use]
    pub const fn limit(mut self, limit: f64) -> Self {
        self.limit = Some(limit);
        self
    }
}

impl Over {
    /// What a quantity is called when so many are put together.
    pub fn of(self, quantity: &str, count: usize) -> String {
        match self {
            Self::One => quantity.to_owned(),
            Self::Mean => format!("{quantity}, mean of {count}"),
            Self::Median => format!("{quantity}, median of {count}"),
            Self::Worst => format!("{quantity}, worst of {count}"),
        }
    }
}
