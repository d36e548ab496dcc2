//! Where results go: standard output in one piece, files whole or not at all.

use std::env;
use std::fmt::Display;
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{self, Path, PathBuf};
use std::process;
use std::sync::Once;
use std::time::{Duration, Instant};

use comfy_table::{ContentArrangement, Table, presets::UTF8_FULL_CONDENSED};
use console::Term;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;

use crate::Error;
use crate::text::printable_path;

/// Prints a report on standard output: for people, or as one JSON object.
///
/// # Errors
/// [`Error::Stdout`] if it cannot be written; a reader that went away (`| head`) is no error.
pub fn show(report: &(impl Serialize + Display), json: bool) -> Result<(), Error> {
    let text = if json {
        serde_json::to_string(report).map_err(|error| Error::Stdout(error.into()))?
    } else {
        report.to_string()
    };
    print(&text)
}

/// Prints a text and a line break on standard output.
///
/// # Errors
/// As [`show`].
pub fn print(text: &str) -> Result<(), Error> {
    let mut stdout = io::stdout().lock();
    done(writeln!(stdout, "{}", text.trim_end()).and_then(|()| stdout.flush()))
}

/// What became of writing to standard output.
///
/// # Errors
/// As [`show`].
pub fn done(written: io::Result<()>) -> Result<(), Error> {
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Error::Stdout(error)),
        _ => Ok(()),
    }
}

/// Says something on standard error that is not a result.
pub fn warn(message: &str) {
    // There is nobody left to tell if standard error is closed.
    let _ = writeln!(io::stderr(), "{message}");
}

/// Says on standard error what a reader of a file should know.
pub fn warn_of(path: &Path, warnings: &[String]) {
    for warning in warnings {
        warn(&format!("warning: {}: {warning}", printable_path(path)));
    }
}

/// Columns of a line of standard output: what `COLUMNS` says, or else those of the terminal. None for a file or a pipe,
/// whose reader looks for whole lines.
pub fn width() -> Option<u16> {
    let said = env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    let said = said.filter(|&columns| columns > 0);
    said.or_else(|| Term::stdout().size_checked().map(|(_, columns)| columns))
}

/// An empty table in the house style, as wide as the terminal at most.
pub fn table() -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED).set_content_arrangement(ContentArrangement::Dynamic);
    if let Some(width) = width() {
        table.set_width(width);
    }
    table
}

/// A progress bar on standard error, invisible unless that is a terminal.
pub fn progress(steps: u64, what: &str) -> ProgressBar {
    let bar = ProgressBar::new(steps);
    style(&bar, what);
    bar
}

fn style(bar: &ProgressBar, what: &str) {
    // The template is a constant; an unknown key would merely leave the default style.
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} {msg} {eta}") {
        bar.set_style(style);
        bar.set_message(what.to_owned());
    }
}

/// A progress bar that appears when the work takes longer than a second, and is invisible before.
pub fn late_progress(steps: u64, what: &str) -> LateProgress {
    let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::hidden());
    style(&bar, what);
    LateProgress { bar, begun: Instant::now(), shown: Once::new() }
}

/// See [`late_progress`].
#[derive(Debug)]
pub struct LateProgress {
    bar: ProgressBar,
    begun: Instant,
    shown: Once,
}

impl LateProgress {
    /// Another step is done.
    pub fn inc(&self) {
        if !self.shown.is_completed() && self.begun.elapsed() > Duration::from_secs(1) {
            self.shown.call_once(|| self.bar.set_draw_target(ProgressDrawTarget::stderr()));
        }
        self.bar.inc(1);
    }
}

impl Drop for LateProgress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Refuses outputs, which are options and their files, if two are one file, or one is an input as well.
///
/// # Errors
/// [`Error::Usage`].
pub fn refuse_clashes<'a>(
    outputs: &[(&str, Option<&Path>)],
    inputs: &(impl IntoIterator<Item = &'a PathBuf> + Clone),
) -> Result<(), Error> {
    refuse_twice(outputs)?;
    outputs.iter().try_for_each(|&(option, path)| refuse_overwriting(option, path, inputs.clone()))
}

/// Refuses to write two results to one file: `outputs` are options and their files.
///
/// # Errors
/// [`Error::Usage`].
pub fn refuse_twice(outputs: &[(&str, Option<&Path>)]) -> Result<(), Error> {
    let mut known: Vec<(&str, PathBuf)> = Vec::new();
    for &(option, path) in outputs {
        let Some(path) = path.and_then(|path| path::absolute(path).ok()) else { continue };
        if let Some((other, _)) = known.iter().find(|(_, taken)| *taken == path) {
            return Err(Error::Usage(format!("{other} and {option} name the same file")));
        }
        known.push((option, path));
    }
    Ok(())
}

/// Refuses to write to a file that is an input as well.
///
/// # Errors
/// [`Error::Usage`].
pub fn refuse_overwriting<'a>(
    option: &str,
    output: Option<&Path>,
    inputs: impl IntoIterator<Item = &'a PathBuf>,
) -> Result<(), Error> {
    let real = |path: &Path| path.canonicalize().ok();
    let Some(output) = output.and_then(real) else { return Ok(()) };
    match inputs.into_iter().find(|path| real(path).as_ref() == Some(&output)) {
        Some(input) => Err(Error::Usage(format!(
            "{option} {} would overwrite an input file",
            printable_path(input)
        ))),
        None => Ok(()),
    }
}

/// Writes a file so that it is never seen half-written: beside it first, then renamed.
///
/// # Errors
/// [`Error::Write`] if anything fails; then whatever stood at `path` is untouched.
pub fn write_file(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Error> {
    let failed = |source| Error::Write { path: path.to_path_buf(), source };
    let draft = draft_path(path).map_err(failed)?;
    let written = write_new(&draft, write).and_then(|()| fs::rename(&draft, path));
    written.map_err(|source| {
        // The draft may not even exist; the first failure is the one worth reporting.
        let _ = fs::remove_file(&draft);
        failed(source)
    })
}

/// A name beside `path` that nobody else uses.
fn draft_path(path: &Path) -> io::Result<PathBuf> {
    // Renaming over a device such as /dev/null would replace the device.
    if path.exists() && !path.is_file() {
        return Err(io::Error::new(ErrorKind::InvalidInput, "it exists and is not a regular file"));
    }
    let name = path.file_name().ok_or_else(|| io::Error::from(ErrorKind::InvalidFilename))?;
    let mut draft = std::ffi::OsString::from(".");
    draft.push(name);
    draft.push(format!(".{}.tmp", process::id()));
    Ok(path.with_file_name(draft))
}

/// Refuses a file that cannot be written, before what would be written is calculated.
///
/// # Errors
/// [`Error::Write`].
pub fn refuse_unwritable(path: &Path) -> Result<(), Error> {
    let failed = |source| Error::Write { path: path.to_path_buf(), source };
    let draft = draft_path(path).map_err(failed)?;
    write_new(&draft, |_| Ok(())).and_then(|()| fs::remove_file(&draft)).map_err(failed)
}

/// Refuses a folder that cannot be made or written into, before what would be written is calculated.
///
/// # Errors
/// [`Error::Write`].
pub fn refuse_unwritable_folder(folder: &Path) -> Result<(), Error> {
    let failed = |source| Error::Write { path: folder.to_path_buf(), source };
    let absolute = path::absolute(folder).map_err(failed)?;
    // What is missing of the path is made below what is there.
    let there = absolute.ancestors().find(|folder| folder.exists()).unwrap_or(&absolute);
    let draft = there.join(format!(".report.{}.tmp", process::id()));
    write_new(&draft, |_| Ok(())).and_then(|()| fs::remove_file(&draft)).map_err(failed)
}

fn write_new(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut file = BufWriter::new(File::create_new(path)?);
    write(&mut file)?;
    file.into_inner()?.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_no_draft() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("track.csv");
        fs::write(&path, "old")?;
        let failed = write_file(&path, |file| {
            file.write_all(b"half")?;
            Err(io::Error::other("full"))
        });
        assert!(failed.is_err());
        assert_eq!(fs::read_to_string(&path)?, "old");
        assert_eq!(fs::read_dir(folder.path())?.count(), 1);
        Ok(())
    }

    #[test]
    fn only_regular_files_are_replaced() {
        assert!(write_file(Path::new("/dev/null"), |_| Ok(())).is_err());
        assert!(write_file(Path::new("/"), |_| Ok(())).is_err());
        assert!(write_file(Path::new("no/such/folder/track.csv"), |_| Ok(())).is_err());
    }
}
