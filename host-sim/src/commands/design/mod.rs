//! `host-sim design`: computes the gains, discretisations, covariances and steady flights of a file of cases.

mod answer;
mod case;
mod report;
mod rust;
mod steady;

use std::path::{Path, PathBuf};

pub use answer::{Answer, Answered};
pub use kestirim_design::Solution;
pub use report::Report;
use serde_json::{Map, Value};
pub use steady::{Steady, Trim};

use crate::text::TextFile;
use crate::{Error, output};

/// Options of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Design {
    /// What to design: JSON with lists `pole_placement`, `must_reject`, `dare`, `dare_reject`, `c2d`, `lyapunov`,
    /// `reduced_order` and `airframe`, each optional
    #[arg(long, value_name = "FILE")]
    input: PathBuf,
    /// Write the results as constants for firmware
    #[arg(long, value_name = "OUT.rs")]
    rust: Option<PathBuf>,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
}

impl Design {
    /// Reads the cases, designs, writes the constants and prints the report.
    ///
    /// # Errors
    /// Errors in the file as a whole; an error in a case becomes that case's answer.
    pub fn run(&self) -> Result<(), Error> {
        output::refuse_overwriting("--rust", self.rust.as_deref(), [&self.input])?;
        let report = answers(&self.input)?;
        if report.sections.is_empty() {
            let names = answer::SECTIONS.map(|(name, _)| name).join(", ");
            let warning = format!("expected one of {names}, found none");
            output::warn_of(&self.input, &[warning]);
        }
        output::warn_of(&self.input, &report.warnings());
        if let Some(path) = &self.rust {
            output::write_file(path, |file| rust::write(file, &report))?;
        }
        output::show(&report, self.json)
    }
}

/// The answers to a file of cases.
///
/// # Errors
/// [`Error::Read`], [`Error::Line`] or [`Error::File`] if the file does not hold cases.
pub fn answers(path: &Path) -> Result<Report, Error> {
    let file = TextFile::read(path)?;
    let cases: Map<String, Value> = file.json("a JSON object of cases")?;
    let mut sections = Vec::new();
    for (name, answer) in answer::SECTIONS {
        let Some(section) = cases.get(name) else { continue };
        let list = section
            .as_array()
            .ok_or_else(|| file.error(format!("{name}: expected a list of cases")))?;
        sections.push((name, list.iter().map(|value| Answered::new(value, answer)).collect()));
    }
    Ok(Report { sections })
}
