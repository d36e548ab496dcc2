//! The recorded part of a chapter: replays of the recordings in a folder of data, beside known results.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::figure::Figure;
use crate::metrics::{mean, median};
use crate::report::{Comparison, Recorded, Replayed, Studied, Value, rounded};
use crate::system::{
    AnySystem, DataFile, Files, Making, Measure, Over, Recorded as Recording, Settings, Source,
    Study, Together, Wanted,
};
use crate::text::printable_path;
use crate::{Error, output};

/// The folder that recordings are read from, and the one that files made from them are written to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Folders<'a> {
    pub(super) data: &'a Path,
    pub(super) report: &'a Path,
}

/// Refuses a folder of data that cannot be read.
pub(super) fn refuse_absent(data: &Path) -> Result<(), Error> {
    let read = data.read_dir().map(drop);
    read.map_err(|source| Error::Read { path: data.to_path_buf(), source })
}

/// The results of a system's recordings; missing and failing ones are named. `None` if the system has no recordings.
/// `command` reproduces the report.
pub(super) fn of(
    system: &dyn AnySystem,
    folders: Folders,
    command: &str,
) -> Result<Option<Recorded>, Error> {
    let studies = system.recorded();
    if studies.is_empty() {
        return Ok(None);
    }
    std::fs::create_dir_all(folders.report)
        .map_err(|source| Error::Write { path: folders.report.to_path_buf(), source })?;
    let count = studies.iter().map(|study| study.recordings.len() as u64).sum();
    let bar = output::progress(count, "recordings");
    let (mut studied, mut left_out) = (Vec::new(), Vec::new());
    for study in studies {
        let of = Of { system, study, folders };
        of.make_files();
        let replays = study.recordings.par_iter().map(|recording| {
            let replay = of.replay(recording);
            bar.inc(1);
            replay.map(|replay| (recording, replay))
        });
        let mut there = Vec::new();
        for replay in replays.collect::<Vec<_>>() {
            match replay {
                Ok(replay) => there.push(replay),
                Err(sentence) if left_out.contains(&sentence) => {}
                Err(sentence) => left_out.push(sentence),
            }
        }
        if !there.is_empty() {
            studied.push(of.studied(there, command));
        }
    }
    bar.finish_and_clear();
    let folder = printable_path(folders.data);
    Ok(Some(Recorded { folder, left_out, studies: studied }))
}

/// The recordings of one kind, with their system and folders.
#[derive(Clone, Copy)]
struct Of<'a> {
    system: &'a dyn AnySystem,
    study: &'static Study,
    folders: Folders<'a>,
}

impl Of<'_> {
    /// Makes the files that are made from others, each once. If one cannot be made, its recordings are left out.
    fn make_files(&self) {
        let mut made: Vec<PathBuf> = Vec::new();
        for (_, file) in self.study.recordings.iter().flat_map(|recording| recording.files) {
            let path = self.path(file);
            let DataFile::Made(Making { of, make, .. }) = file else { continue };
            let are_there = of.iter().all(|part| self.folders.data.join(part).is_file());
            if made.contains(&path) || !are_there {
                continue;
            }
            // A file of an earlier report must not be taken for the one made now.
            let _ = std::fs::remove_file(&path);
            if let Err(error) = make(self.folders.data, &path) {
                output::warn(&format!("warning: {error}"));
            }
            made.push(path);
        }
    }

    fn path(&self, file: &DataFile) -> PathBuf {
        let Folders { data, report } = self.folders;
        match file {
            DataFile::There(path) => data.join(path),
            DataFile::Made(making) => report.join(format!("{}-{}", self.id(), making.name)),
        }
    }

    fn id(&self) -> String {
        format!("{}-recorded-{}", self.system.name(), self.study.id)
    }

    /// The result of a recording, or the reason why there is none.
    fn replay(&self, recording: &Recording) -> Result<Replayed, String> {
        let absent = |path: &&str| !self.folders.data.join(path).is_file();
        let mut missing = recording.needs().filter(absent);
        if let Some(first) = missing.next() {
            let are = match missing.count() {
                0 => " is".to_owned(),
                more => format!(" and {more} more are"),
            };
            return Err(format!("{}: {first}{are} missing", recording.name));
        }
        self.opened(recording).map_err(|error| format!("{}: {error}", recording.name))
    }

    fn opened(&self, recording: &Recording) -> Result<Replayed, Error> {
        let mut settings = Settings::new(self.system.settings());
        for (name, value) in recording.settings {
            settings.set(name, value)?;
        }
        let mut files = Files::default();
        for (field, file) in recording.files {
            files.add(*field, self.path(file));
        }
        let opened = self.system.open(Source::Files(files), &settings)?;
        let answer = opened.answer(&settings)?;
        let account = opened.replay(&settings, &Wanted::default())?;
        let values = self.study.measures.iter().map(|measure| {
            let number = account.report.pointer(measure.at).and_then(serde_json::Value::as_f64);
            let value = Value::new(measure.quantity, measure.unit).under(recording.name);
            value.by(recording.method).is(number.map(|number| measure.scale * number))
        });
        Ok(Replayed {
            name: recording.title(),
            values: values.collect(),
            health: account.health.to_string(),
            commands: recording.made().chain([answer.command.clone()]).collect(),
            figures: self.figures(recording, &answer.figures),
        })
    }

    /// The figures to show, with unique ids. Results of the published method appear in the figures of ours.
    fn figures(&self, recording: &Recording, figures: &[Figure]) -> Vec<Figure> {
        let shown = self.study.figures.iter().filter(|_| recording.is_ours());
        let shown = shown.filter_map(|id| figures.iter().find(|figure| figure.id == *id));
        shown
            .map(|figure| Figure {
                id: format!(
                    "{}-{}-{}",
                    self.id(),
                    recording.name.replace([' ', '_'], "-"),
                    figure.id
                ),
                title: format!("{}: {}", recording.name, figure.title),
                ..figure.clone()
            })
            .collect()
    }

    /// The results of all recordings together.
    fn studied(&self, there: Vec<(&Recording, Replayed)>, command: &str) -> Studied {
        let mut table = Comparison::new(self.id(), self.study.title).note(self.study.note);
        for (place, measure) in self.study.measures.iter().enumerate() {
            let numbers = |ours: bool| -> Vec<f64> {
                let of = there.iter().filter(|(recording, _)| recording.is_ours() == ours);
                let values = of.filter_map(|(_, replay)| replay.values.get(place)?.value);
                values.map(f64::abs).collect()
            };
            for together in measure.together {
                table =
                    self.put_together(table, measure, together, [numbers(true), numbers(false)]);
            }
        }
        let with_unit = |measure: &Measure| match measure.unit {
            "" => measure.quantity.to_owned(),
            unit => format!("{}, {unit}", measure.quantity),
        };
        Studied {
            table,
            command: command.to_owned(),
            quantities: self.study.measures.iter().map(with_unit).collect(),
            replays: there.into_iter().map(|(_, replay)| replay).collect(),
        }
    }

    /// Adds a row and its numbers. Known values apply only if no recording is missing.
    fn put_together(
        &self,
        table: Comparison,
        measure: &Measure,
        &Together { over, known, limit }: &Together,
        [ours, theirs]: [Vec<f64>; 2],
    ) -> Comparison {
        let are_all = ours.len() == self.study.count();
        let [known, limit] = [known, limit].map(|number| number.filter(|_| are_all));
        let quantity = over.of(measure.quantity, ours.len().max(theirs.len()));
        let name = [&quantity, measure.unit].map(str::to_owned);
        let [our, their] = [&ours, &theirs].map(|numbers| put_together(over, numbers));
        let text = |number: Option<f64>| number.map_or_else(String::new, rounded);
        let value = Value::new(quantity.clone(), measure.unit).under(self.study.title);
        let value = |number, of: &[f64]| value.clone().is(number).of(of.len(), None);
        let others = their.map(|their| value(Some(their), &theirs).by(Recording::THEIRS));
        let name = name.join(", ").trim_end_matches(", ").to_owned();
        table
            .beside(name, text(known), text(their), text(our), text(limit))
            .values([value(our, &ours).published(known).limited(limit)])
            .values(others)
    }
}

/// Combines magnitudes; `None` if there are none.
fn put_together(over: Over, magnitudes: &[f64]) -> Option<f64> {
    (!magnitudes.is_empty()).then(|| match over {
        Over::One | Over::Mean => mean(magnitudes),
        Over::Median => median(magnitudes),
        Over::Worst => magnitudes.iter().copied().fold(0.0, f64::max),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::systems::ALL;

    #[test]
    fn what_a_system_declares_it_has() {
        for system in ALL {
            for study in system.recorded() {
                let mut names: Vec<_> = study.recordings.iter().map(Recording::title).collect();
                names.dedup();
                assert_eq!(names.len(), study.recordings.len(), "{}", study.id);
                let (name, _) = system.synthetic()[0];
                let settings = Settings::new(system.settings());
                let synthetic = Source::Synthetic(name.to_owned());
                let opened = system.open(synthetic, &settings).expect("a synthetic recording");
                let answer = opened.answer(&settings).expect("an answer");
                for id in study.figures {
                    assert!(answer.figures.iter().any(|figure| figure.id == *id), "{id}");
                }
                for recording in study.recordings {
                    let mut settings = Settings::new(system.settings());
                    for (name, value) in recording.settings {
                        settings.set(name, value).expect("a value of a setting");
                    }
                    let is_known = |field: &str| system.files().iter().any(|it| it.name == field);
                    assert!(recording.files.iter().all(|(field, _)| is_known(field)));
                }
            }
        }
    }

    #[test]
    fn magnitudes_are_put_together() {
        assert_eq!(put_together(Over::Worst, &[1.0, 4.0, 2.0]), Some(4.0));
        assert_eq!(put_together(Over::Median, &[1.0, 4.0, 2.0]), Some(2.0));
        assert_eq!(put_together(Over::Mean, &[]), None);
    }
}
