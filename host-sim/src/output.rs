//! Output of results: standard output in one piece, files atomically.

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

/// Prints a report on standard output: as text, or as one JSON object.
///
/// # Errors
/// [`Error::Stdout`] if it cannot be written; a reader that closes the pipe (`| head`) is no error.
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
/// [`Error::Stdout`] if it cannot be written; a closed pipe is no error.
pub fn print(text: &str) -> Result<(), Error> {
    let mut stdout = io::stdout().lock();
    done(writeln!(stdout, "{}", text.trim_end()).and_then(|()| stdout.flush()))
}

/// The outcome of writing to standard output; a closed pipe counts as success.
///
/// # Errors
/// [`Error::Stdout`] if it cannot be written.
pub fn done(written: io::Result<()>) -> Result<(), Error> {
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Error::Stdout(error)),
        _ => Ok(()),
    }
}

/// Prints a message that is not a result on standard error.
pub fn warn(message: &str) {
    // If standard error is closed the message has nowhere to go.
    let _ = writeln!(io::stderr(), "{message}");
}

/// Prints warnings about a file on standard error.
pub fn warn_of(path: &Path, warnings: &[String]) {
    for warning in warnings {
        warn(&format!("warning: {}: {warning}", printable_path(path)));
    }
}

/// The width of standard output in columns: `COLUMNS`, or else that of the terminal. `None` for a file or a pipe, whose
/// readers expect unbroken lines.
pub fn width() -> Option<u16> {
    let said = env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    let said = said.filter(|&columns| columns > 0);
    said.or_else(|| Term::stdout().size_checked().map(|(_, columns)| columns))
}

/// An empty table in the house style, at most as wide as the terminal.
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

/// A progress bar that appears only once the work has taken longer than a second.
pub fn late_progress(steps: u64, what: &str) -> LateProgress {
    let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::hidden());
    style(&bar, what);
    LateProgress { bar, begun: Instant::now(), shown: Once::new() }
}

/// The progress bar that [`late_progress`] returns.
#[derive(Debug)]
pub struct LateProgress {
    bar: ProgressBar,
    begun: Instant,
    shown: Once,
}

impl LateProgress {
    /// Advances the bar by a step.
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

/// Refuses `outputs` (pairs of option and file) if two are the same file, or one is also an input.
///
/// # Errors
/// [`Error::Usage`] that names the clash.
pub fn refuse_clashes<'a>(
    outputs: &[(&str, Option<&Path>)],
    inputs: &(impl IntoIterator<Item = &'a PathBuf> + Clone),
) -> Result<(), Error> {
    refuse_twice(outputs)?;
    outputs.iter().try_for_each(|&(option, path)| refuse_overwriting(option, path, inputs.clone()))
}

/// Refuses to write two results to the same file: `outputs` are pairs of option and file.
///
/// # Errors
/// [`Error::Usage`] that names the two options.
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

/// Refuses to write to a file that is also an input.
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

/// Writes a file atomically: to a draft beside it first, which is then renamed.
///
/// # Errors
/// [`Error::Write`] if anything fails; whatever was at `path` is then untouched.
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

/// A name beside `path` that no other file or process uses.
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

/// Refuses a file that cannot be written, before its contents are computed.
///
/// # Errors
/// [`Error::Write`].
pub fn refuse_unwritable(path: &Path) -> Result<(), Error> {
    let failed = |source| Error::Write { path: path.to_path_buf(), source };
    let draft = draft_path(path).map_err(failed)?;
    write_new(&draft, |_| Ok(())).and_then(|()| fs::remove_file(&draft)).map_err(failed)
}

/// Refuses a folder that cannot be created or written to, before its contents are computed.
///
/// # Errors
/// [`Error::Write`].
pub fn refuse_unwritable_folder(folder: &Path) -> Result<(), Error> {
    let failed = |source| Error::Write { path: folder.to_path_buf(), source };
    let absolute = path::absolute(folder).map_err(failed)?;
    // The missing part of the path will be created below the part that exists.
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
