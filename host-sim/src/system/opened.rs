//! An open recording, and the evaluations that can be run on it.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use kestirim_replay::Finding;

use super::account::{Account, Answer, Table};
use super::answers::Answers;
use super::face::{Detail, System};
use super::files::Source;
use super::idle::{Idle, refuse};
use super::setting::Setting;
use super::settings::Settings;
use crate::{Error, mcap, output, text};

/// The files that a replay is to write.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Wanted {
    /// The options of tables with the files to write them to.
    pub tables: Vec<(&'static str, PathBuf)>,
    /// The file to write the streams to.
    pub mcap: Option<PathBuf>,
}

impl Wanted {
    /// Whether anything is to be written.
    pub fn any(&self) -> bool {
        self.first().is_some()
    }

    /// The first option that names a file to write.
    fn first(&self) -> Option<&'static str> {
        let table = self.tables.first().map(|(output, _)| *output);
        table.or_else(|| self.mcap.as_ref().map(|_| "mcap"))
    }
}

/// An open recording of any system.
pub trait Opened: Send + Sync {
    /// The available settings.
    fn settings(&self) -> Vec<Setting>;

    /// Replays the recording, writes the files that are wanted, and returns the account.
    ///
    /// # Errors
    /// A one-sentence error if the recording and the settings give no result, a setting would have no effect, or a file
    /// cannot be written.
    fn replay(&self, settings: &Settings, wanted: &Wanted) -> Result<Account, Error>;

    /// Findings about the recording itself, made before any estimator has run.
    ///
    /// # Errors
    /// [`Error::Usage`] for settings that would have no effect.
    fn check(&self, settings: &Settings) -> Result<Vec<Finding>, Error>;

    /// The answer that the page shows, with the settings that have no effect.
    ///
    /// # Errors
    /// A one-sentence error if the recording and the settings give no result.
    fn answer(&self, settings: &Settings) -> Result<Arc<Answer>, Error>;

    /// The settings without those that have no effect.
    fn effective(&self, settings: &Settings) -> Settings;

    /// Drops cached answers that take much memory.
    fn forget_large(&self);
}

/// A recording with the last track computed from it.
struct Open<S: System> {
    recording: S::Recording,
    source: Source,
    last: Mutex<Option<Last<S>>>,
    answers: Answers,
    findings: Mutex<Option<(Settings, Vec<Finding>)>>,
}

/// The settings and detail of a track, and the track.
struct Last<S: System> {
    settings: Settings,
    detail: Detail,
    trace: Arc<S::Trace>,
}

pub(super) fn open<S: System>(recording: S::Recording, source: Source) -> Box<dyn Opened> {
    let (last, answers, findings) = (Mutex::new(None), Answers::default(), Mutex::new(None));
    Box::new(Open::<S> { recording, source, last, answers, findings })
}

impl<S: System> Open<S> {
    /// The track, computed again only if the settings or the detail require another one.
    fn trace(&self, settings: &Settings, detail: Detail) -> Result<Arc<S::Trace>, Error> {
        let key = settings.without_views();
        {
            let last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some(last) = last.as_ref().filter(|it| it.settings == key && it.detail >= detail)
            {
                return Ok(Arc::clone(&last.trace));
            }
        }
        let trace = Arc::new(S::track(&self.recording, settings, detail)?);
        let last = Last { settings: key, detail, trace: Arc::clone(&trace) };
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = Some(last);
        Ok(trace)
    }

    /// The findings about the recording, computed again only if settings that describe it change.
    fn findings(&self, settings: &Settings) -> Vec<Finding> {
        let key = settings.without(|name| !S::CHECKED.contains(&name));
        let mut last = self.findings.lock().unwrap_or_else(PoisonError::into_inner);
        match last.as_ref() {
            Some((known, findings)) if *known == key => findings.clone(),
            _ => {
                let findings = S::check(&self.recording, settings);
                *last = Some((key, findings.clone()));
                findings
            }
        }
    }

    /// The account of a track, with the findings about the recording.
    fn account(
        &self,
        settings: &Settings,
        trace: &S::Trace,
    ) -> Result<(Account, Vec<Finding>), Error> {
        let mut account = S::account(&self.recording, settings, trace)?;
        let findings = self.findings(settings);
        for finding in &findings {
            if let Some(reason) = finding.reason {
                account.warn(finding.sentence());
                account.doubt(reason);
            }
        }
        account.tell_health();
        Ok((account, findings))
    }

    fn idle(&self, settings: &Settings, name: &str) -> Option<Idle> {
        S::idle(Some(&self.recording), settings, name)
    }

    /// Settings that have no effect given the others, and why.
    fn disabled(&self, settings: &Settings) -> Vec<(&'static str, String)> {
        let table = settings.table().iter();
        let reason = |name| Some((name, self.idle(settings, name)?.reason().to_owned()));
        table.filter_map(|setting| reason(setting.name)).collect()
    }
}

impl<S: System> Opened for Open<S> {
    fn settings(&self) -> Vec<Setting> {
        S::settings(Some(&self.recording))
    }

    fn replay(&self, settings: &Settings, wanted: &Wanted) -> Result<Account, Error> {
        refuse(settings, |name| self.idle(settings, name))?;
        if let (Some(output), Some(reason)) = (wanted.first(), S::lacks_output(settings)) {
            return Err(Error::Usage(format!("--{output} {reason}")));
        }
        let views = settings.table().iter().any(|it| it.is_view && settings.is_given(it.name));
        let detail = if wanted.any() || views { Detail::Every } else { Detail::Result };
        let trace = self.trace(settings, detail)?;
        let (account, findings) = self.account(settings, &trace)?;
        let of_all = Finding::doubts(&findings).state();
        for (output, path) in &wanted.tables {
            let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
            let ending = ending.to_ascii_lowercase();
            if let Some(text) = S::text(output, &ending, &self.recording, &trace) {
                output::write_file(path, |file| file.write_all(text.as_bytes()))?;
                continue;
            }
            let table = S::table(output, &self.recording, settings, &trace);
            write(path, &table.with_health(of_all))?;
        }
        if let Some(path) = &wanted.mcap {
            mcap::write(path, &S::streams(&self.recording, settings, &trace))?;
        }
        Ok(account)
    }

    fn check(&self, settings: &Settings) -> Result<Vec<Finding>, Error> {
        refuse(settings, |name| self.idle(settings, name))?;
        Ok(self.findings(settings))
    }

    fn forget_large(&self) {
        self.answers.forget_large();
    }

    fn effective(&self, settings: &Settings) -> Settings {
        without(settings, &self.disabled(settings))
    }

    fn answer(&self, settings: &Settings) -> Result<Arc<Answer>, Error> {
        if let Some(known) = self.answers.of(settings) {
            return Ok(known);
        }
        let (asked, disabled) = (settings, self.disabled(settings));
        // A page that was left open still sends disabled settings, which the command line refuses.
        let settings = &without(settings, &disabled);
        let trace = self.trace(settings, Detail::Every)?;
        let (Account { facts, warnings, .. }, findings) = self.account(settings, &trace)?;
        let command = ["host-sim", "replay", S::NAME].map(str::to_owned).into_iter();
        let command = command.chain(self.source.arguments()).chain(settings.arguments());
        let mut answer = Answer {
            facts,
            warnings,
            figures: Vec::new(),
            tables: Vec::new(),
            disabled,
            command: text::command_line(command),
            firmware: S::firmware(Some(&self.recording), settings),
            findings,
        };
        S::figures(&self.recording, settings, &trace, &mut answer)?;
        Ok(self.answers.keep(asked, answer))
    }
}

/// The settings without the disabled ones.
fn without(settings: &Settings, disabled: &[(&'static str, String)]) -> Settings {
    settings.without(|name| disabled.iter().any(|(idle, _)| *idle == name))
}

fn write(path: &std::path::Path, Table { header, rows, .. }: &Table) -> Result<(), Error> {
    output::write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        table.write_record(header)?;
        rows.iter().try_for_each(|row| table.write_record(row))?;
        table.flush()
    })
}
