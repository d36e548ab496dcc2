//! Replays many recordings of a system into a table with a line each.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ArgMatches;
use kestirim_sweep::archive::{self, Line};
use kestirim_sweep::table::{Tail, check_ending};
use kestirim_sweep::{Block, Input, Logs, Plan, Program, matching};
use rayon::prelude::*;
use serde_json::json;

use super::sweep::named;
use crate::system::{AnySystem, FileField, Files, Settings, Source, Wanted};
use crate::text::command_line;
use crate::{Error, output};

/// The recordings of a system, each replayed with several sets of settings.
struct Archive {
    system: &'static dyn AnySystem,
    configs: Vec<Settings>,
    logs: Logs,
    folder: PathBuf,
    /// The files that all recordings share.
    files: Files,
    /// The name of the field that the recordings themselves fill.
    field: &'static str,
}

impl Archive {
    /// An archive whose recordings fill the only required field that is not among the shared files.
    fn new(
        system: &'static dyn AnySystem,
        configs: Vec<Settings>,
        logs: Logs,
        folder: PathBuf,
        files: Files,
    ) -> Result<Self, Error> {
        let known = |name: &String| system.files().iter().any(|field| field.name == *name);
        if let Some(name) = logs.files.keys().find(|name| !known(name)) {
            return Err(Error::Usage(format!("{} has no file {name:?}", system.name())));
        }
        let missing = |field: &&FileField| field.required && !logs.files.contains_key(field.name);
        let missing: Vec<_> = system.files().iter().filter(missing).map(|it| it.name).collect();
        match missing[..] {
            [field] => Ok(Self { system, configs, logs, folder, files, field }),
            [] => Err(Error::Usage("no file is left that the pattern could name".to_owned())),
            _ => Err(Error::Usage(format!(
                "a pattern names one kind of file, and the others are needed: --{}",
                missing.join(" or --")
            ))),
        }
    }

    /// The files of a recording.
    fn files(&self, path: &Path) -> Files {
        let mut files = self.files.clone();
        files.add(self.field, self.folder.join(path));
        for (name, paths) in self.logs.of(path) {
            for path in paths {
                files.add(name, self.folder.join(path));
            }
        }
        files
    }

    /// Reads a recording once and tracks it with each set of settings; errors are reported in its lines.
    fn lines(&self, path: &Path) -> Vec<Line> {
        let opened = self.system.open(Source::Files(self.files(path)), &self.configs[0]);
        let line = |settings: &Settings| {
            let mut line = Line {
                recording: path.display().to_string(),
                settings: command_line(settings.arguments()),
                ..Line::default()
            };
            let account = match &opened {
                Ok(opened) => opened.replay(settings, &Wanted::default()),
                Err(error) => Err(Error::Usage(error.to_string())),
            };
            match account {
                Ok(account) => {
                    line.health = account.health.to_string();
                    line.warnings = account.warnings.join(" | ");
                    line.report = account.report;
                }
                Err(error) => line.error = error.to_string(),
            }
            line
        };
        self.configs.iter().map(line).collect()
    }
}

/// The recordings of a plan as a block of trials.
pub(super) fn block(plan: &Plan, logs: &Logs) -> Result<Block, Error> {
    let system = named(plan.studies.first().map_or("", |study| &study.system))?;
    let (configs, folder) = (configs(system, plan)?, plan.folder.clone());
    let archive = Archive::new(system, configs, logs.clone(), folder, Files::default())?;
    let (columns, count) = (archive::columns(archive.configs.len()), logs.paths.len() as u64);
    Ok(Block::of_records("recordings", columns, count, move |index| {
        Ok(archive::row(&archive.lines(&archive.logs.paths[index as usize])))
    }))
}

/// The settings of each study of a plan of recordings.
pub(super) fn configs(system: &dyn AnySystem, plan: &Plan) -> Result<Vec<Settings>, Error> {
    let config = |study: &kestirim_sweep::Study| {
        let mut settings = Settings::new(system.settings());
        study.settings.iter().try_for_each(|(name, text)| settings.set(name, text))?;
        system.refuse_idle(&settings).map(|()| settings)
    };
    plan.studies.iter().map(config).collect()
}

/// Runs `replay SYSTEM --logs PATTERN --out TABLE`: errors in a recording do not end the run.
pub(super) fn run(
    system: &'static dyn AnySystem,
    matches: &ArgMatches,
    (settings, files): (Settings, Files),
    pattern: &str,
) -> Result<(), Error> {
    let out = matches.get_one::<PathBuf>("out");
    let out = out.ok_or_else(|| Error::Usage("--logs needs --out TABLE.csv".to_owned()))?;
    check_ending(out)?;
    system.refuse_idle(&settings)?;
    let folder = PathBuf::new();
    let named = system.files().iter().filter_map(|field| {
        let texts = files.all(field.name).iter().map(|path| path.to_string_lossy().into_owned());
        let texts: Vec<_> = texts.collect();
        (!texts.is_empty()).then(|| (field.name.to_owned(), texts))
    });
    let logs = Logs { files: named.collect(), paths: matching(pattern, &folder)? };
    let mut common = Files::default();
    common.reading = files.reading;
    let archive = Archive::new(system, vec![settings], logs, folder, common)?;
    let all = archive.logs.paths.iter().map(|path| archive.files(path));
    let inputs: Vec<_> = all.flat_map(|it| it.paths().cloned().collect::<Vec<_>>()).collect();
    output::refuse_overwriting("--out", Some(out), &inputs)?;
    let bar = output::progress(archive.logs.paths.len() as u64, "recordings");
    let lines = archive.logs.paths.par_iter().map(|path| {
        let begun = Instant::now();
        let mut lines = archive.lines(path);
        for line in &mut lines {
            line.seconds = Some(begun.elapsed().as_secs_f64());
        }
        bar.inc(1);
        lines
    });
    let lines = lines.collect::<Vec<_>>().concat();
    bar.finish_and_clear();
    write(out, system, &lines, Input::all(inputs, Path::new(""))?)?;
    conclude(&lines)
}

/// Prints how many recordings are in each state.
///
/// # Errors
/// No recording has a result: what the first lacks is most likely what all lack.
pub(super) fn conclude(lines: &[Line]) -> Result<(), Error> {
    output::print(&archive::counts(lines))?;
    match lines.first() {
        Some(first) if lines.iter().all(|line| !line.error.is_empty()) => {
            Err(Error::Usage(format!("no recording has a result; the first: {}", first.error)))
        }
        _ => Ok(()),
    }
}

/// Writes a table together with a description of its origin.
pub(super) fn write(
    out: &Path,
    system: &dyn AnySystem,
    lines: &[Line],
    inputs: Vec<Input>,
) -> Result<(), Error> {
    let head = json!({ "program": Program::this(), "system": system.name() });
    Ok(archive::write(out, lines, &head, &Tail { inputs, ..Tail::default() })?)
}
