//! The outputs of a run besides the terminal.

use std::path::{Path, PathBuf};

use crate::report::{self, Chapter};
use crate::{Error, mcap, output};

/// Options of every `host-sim run`.
#[derive(Debug, Clone, Default, PartialEq, Eq, clap::Args)]
#[command(next_help_heading = "Output")]
pub struct Outputs {
    /// Print one JSON object instead of a table
    #[arg(long)]
    pub json: bool,
    /// Write the tables: published, ours, limit
    #[arg(long, value_name = "OUT.csv")]
    pub csv: Option<PathBuf>,
    /// Write the streams of a typical run as MCAP, which Foxglove and others open
    #[arg(long, value_name = "OUT.mcap")]
    pub mcap: Option<PathBuf>,
    /// Write this system's part of the report, a page and its figures, into a folder
    #[arg(long, value_name = "FOLDER")]
    pub report: Option<PathBuf>,
}

impl Outputs {
    /// Whether any file is to be written.
    pub const fn any_file(&self) -> bool {
        self.csv.is_some() || self.mcap.is_some() || self.report.is_some()
    }

    /// Refuses options that contradict each other, and files that cannot be written.
    ///
    /// # Errors
    /// [`Error::Usage`] for contradicting options, [`Error::Write`] for unwritable files.
    pub fn check(&self) -> Result<(), Error> {
        output::refuse_twice(&[("--csv", self.csv.as_deref()), ("--mcap", self.mcap.as_deref())])?;
        let mut files = self.csv.iter().chain(&self.mcap);
        files.try_for_each(|file| output::refuse_unwritable(file))?;
        self.report.as_deref().map_or(Ok(()), output::refuse_unwritable_folder)
    }

    /// Separate outputs for one study of several: `a.csv` becomes `a-0.csv`.
    #[must_use]
    pub fn of_study(&self, number: usize, of: usize) -> Self {
        let own = |path: &PathBuf| {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            let ending = path.extension().map(|it| format!(".{}", it.to_string_lossy()));
            let name = format!("{stem}-{number}{}", ending.unwrap_or_default());
            if of == 1 { path.clone() } else { path.with_file_name(name) }
        };
        let Self { json, csv, mcap, report } = self;
        let [csv, mcap, report] = [csv, mcap, report].map(|path| path.as_ref().map(own));
        Self { json: *json, csv, mcap, report }
    }

    /// Writes the requested files.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn write(&self, chapter: Chapter) -> Result<(), Error> {
        if let Some(path) = &self.mcap {
            mcap::write(path, &chapter.streams)?;
        }
        let chapters = [chapter];
        if let Some(path) = &self.csv {
            report::csv::write(path, &chapters)?;
        }
        if let Some(folder) = &self.report {
            say_where(&report::write(folder, &chapters)?);
        }
        Ok(())
    }
}

/// Prints the path of the page on standard error.
pub fn say_where(page: &Path) {
    output::warn(&format!("report: {}", crate::text::printable_path(page)));
}
