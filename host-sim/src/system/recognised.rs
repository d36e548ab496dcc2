//! Recognition of files by their contents: which files of which system they are.

use std::path::{Path, PathBuf};

use super::any::AnySystem;
use super::files::{FileField, Files, Source};
use super::settings::Settings;
use crate::text::{file_name, listed, printable};
use crate::{Error, table};

/// The maximum number of files named in an error message.
const MOST_NAMED: usize = 3;

/// The files of a recording, and what each was recognised as.
#[derive(Debug)]
pub(crate) struct Recognised {
    /// The system whose recording it is.
    pub system: &'static dyn AnySystem,
    /// The files to open.
    pub files: Files,
    /// The recognised files, each with the field that it fills.
    pub taken: Vec<(PathBuf, &'static FileField)>,
    /// The unused files, including those of another recording.
    pub left: Vec<PathBuf>,
    /// Other systems that could read the files as well.
    pub others: Vec<&'static str>,
}

impl Recognised {
    /// Finds the system whose recording the files are. If there are several, it is the one with the most files, and the
    /// `preferred` one if nothing else decides.
    ///
    /// # Errors
    /// [`Error::Usage`] that names the missing files, or if no system reads any file.
    pub(crate) fn of(
        systems: &[&'static dyn AnySystem],
        preferred: &str,
        paths: &[PathBuf],
        files: &Files,
    ) -> Result<Self, Error> {
        let candidates: Vec<_> = paths.iter().filter(|path| !is_track(path)).cloned().collect();
        let mut found: Vec<_> =
            systems.iter().map(|system| Self::of_system(*system, &candidates, files)).collect();
        let rank =
            |it: &Self| (it.missing().is_empty(), it.taken.len(), it.system.name() == preferred);
        // The sort is stable: the first of equals stays first.
        found.sort_by_key(|it| std::cmp::Reverse(rank(it)));
        let mut found = found.into_iter().filter(|it| !it.taken.is_empty());
        let Some(mut best) = found.next() else {
            return Err(nothing_found(systems, preferred, paths, files));
        };
        let missing = best.missing();
        if !missing.is_empty() {
            let known = best.taken.iter().take(MOST_NAMED);
            let known: Vec<_> =
                known.map(|(path, field)| format!("{} (--{})", name(path), field.name)).collect();
            return Err(Error::Usage(format!(
                "{} has {}; needed as well: --{}",
                best.system.name(),
                known.join(", "),
                missing.join(", --")
            )));
        }
        let equals = |it: &Self| it.missing().is_empty() && it.taken.len() == best.taken.len();
        let is_taken = |path: &&PathBuf| best.taken.iter().any(|(taken, _)| taken == *path);
        best.left = paths.iter().filter(|path| !is_taken(path)).cloned().collect();
        best.others = found.filter(equals).map(|it| it.system.name()).collect();
        Ok(best)
    }

    /// Assigns files to the fields of a system, the required fields first.
    fn of_system(system: &'static dyn AnySystem, paths: &[PathBuf], files: &Files) -> Self {
        let mut recognised = Self {
            system,
            files: files.clone(),
            taken: Vec::new(),
            left: paths.to_vec(),
            others: Vec::new(),
        };
        let fields = system.files();
        let required = fields.iter().filter(|field| field.required);
        for field in required.chain(fields.iter().filter(|field| !field.required)) {
            recognised.fill(field);
        }
        recognised
    }

    /// Fills a field with the file that fits it best, or with all that fit if it allows several.
    fn fill(&mut self, field: &'static FileField) {
        let fits = |path: &PathBuf| {
            self.system.fits(field.name, path, &self.files)
                && !self.is_another_recording(path, field)
        };
        let mut fitting: Vec<_> = self.left.iter().filter(|path| fits(path)).cloned().collect();
        // Files that are read alike are told apart by their names.
        fitting.sort_by_key(|path| {
            let is_of_another =
                self.system.files().iter().any(|it| it.name != field.name && says(path, it));
            (is_of_another, !says(path, field), !self.is_beside(path))
        });
        if !field.several {
            fitting.truncate(1);
        }
        for path in fitting {
            self.left.retain(|left| *left != path);
            self.files.add(field.name, &path);
            self.taken.push((path, field));
        }
    }

    /// Whether a file could be another main log, and is not named after `field`.
    fn is_another_recording(&self, path: &Path, field: &FileField) -> bool {
        let mut single = self.system.files().iter().filter(|it| it.required && !it.several);
        !field.required
            && !says(path, field)
            && single.any(|it| self.system.fits(it.name, path, &self.files))
    }

    /// Whether the file name begins like that of a file already taken.
    fn is_beside(&self, path: &Path) -> bool {
        // A compressed file has two endings.
        let stem = |path: &Path| file_name(path).split('.').next().unwrap_or_default().to_owned();
        let own = stem(path);
        let begins = |of: &str| {
            let rest = own.strip_prefix(of);
            rest.is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
        };
        self.taken.iter().any(|(path, _)| begins(&stem(path)))
    }

    /// The required fields that are not filled.
    fn missing(&self) -> Vec<&'static str> {
        let fields = self.system.files().iter();
        let missing = fields.filter(|field| field.required && self.files.one(field.name).is_none());
        missing.map(|field| field.name).collect()
    }
}

/// Whether the file is a track written by this program: neither sensor logs nor truths have its `health` column.
fn is_track(path: &Path) -> bool {
    table::has(path, ["health"])
}

/// Whether the name of a file contains that of a field.
fn says(path: &Path, field: &FileField) -> bool {
    path.file_stem().is_some_and(|stem| stem.to_string_lossy().to_lowercase().contains(field.name))
}

fn name(path: &Path) -> String {
    printable(&file_name(path))
}

/// The error that no system reads any of these files; for a single file it is that of the preferred system's reader.
fn nothing_found(
    systems: &[&'static dyn AnySystem],
    preferred: &str,
    paths: &[PathBuf],
    files: &Files,
) -> Error {
    let system = systems.iter().find(|system| system.name() == preferred);
    let field = system.and_then(|system| system.files().iter().find(|field| field.imported));
    if let (Some(system), Some(field), [path]) = (system, field, paths) {
        let mut files = files.clone();
        files.add(field.name, path);
        let opened = system.open(Source::Files(files), &Settings::new(system.settings()));
        if let Some(error @ (Error::File { .. } | Error::Line { .. })) = opened.err() {
            return error;
        }
    }
    let names: Vec<_> = paths.iter().map(|path| name(path)).collect();
    let names = listed(names.iter().map(String::as_str), MOST_NAMED);
    Error::Usage(format!("no system reads {names}"))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::env;

    use super::super::recorded::{DataFile, Recorded};
    use super::*;
    use crate::systems::ALL;

    /// The files of a recording in a folder, with their fields; `None` if one of them is made from others.
    fn files(recorded: &Recorded, folder: &Path) -> Option<BTreeMap<PathBuf, &'static str>> {
        let files = recorded.files.iter().map(|(field, file)| match file {
            DataFile::There(path) => Some((folder.join(path), *field)),
            DataFile::Made(_) => None,
        });
        files.collect()
    }

    #[test]
    fn a_name_goes_with_the_recording_that_it_is_called_after() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).expect("it is written");
            path
        };
        let anchors = "anchor,x,y,z\nA,0,0,2\nB,9,0,2\nC,0,9,2\n";
        let ranges = "t,anchor,range\n0,A,3\n0,B,4\n0,C,5\n1,A,3\n";
        let paths = [
            file("anchors.csv", anchors),
            file("run1.csv", ranges),
            file("run10-truth.csv", "t,x,y\n0,1,1\n9,1,1\n"),
            file("run1-truth.csv", "t,x,y\n0,2,2\n9,2,2\n"),
            // The track that was computed from the recording is neither its truth nor its height.
            file("track.csv", "t,x,y,z,sx,sy,sz,health\n0,1,1,1,0,0,0,good\n"),
            // Reference points of a tag that is put down.
            file("points.csv", "point,x,y,z\nP,1,1,1\n"),
        ];
        let found = Recognised::of(&ALL, "", &paths, &Files::default()).expect("a recording");
        let truth = found.files.one("truth").and_then(Path::file_name);
        assert_eq!(truth, Some("run1-truth.csv".as_ref()));
        let left: Vec<_> = found.left.iter().map(|path| file_name(path)).collect();
        assert_eq!(left, ["run10-truth.csv", "track.csv", "points.csv"]);
    }

    #[test]
    fn recordings_of_every_system_are_recognised() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
        if !folder.is_dir() {
            let required = env::var("KESTIRIM_REQUIRE_DATA").is_ok_and(|value| value == "1");
            assert!(!required, "KESTIRIM_REQUIRE_DATA=1, but {} is absent", folder.display());
            eprintln!("SKIPPED: recordings are recognised: {} is absent", folder.display());
            return;
        }
        let mut looked_at = 0;
        for system in ALL {
            let all = system.recorded().iter().flat_map(|study| study.recordings);
            for recorded in all.filter(|recorded| recorded.is_ours()) {
                let Some(files) = files(recorded, &folder) else { continue };
                let paths: Vec<_> = files.keys().cloned().collect();
                let found = Recognised::of(&ALL, "", &paths, &Files::default());
                let found = found.unwrap_or_else(|error| panic!("{}: {error}", recorded.name));
                assert_eq!(found.system.name(), system.name(), "{}", recorded.name);
                for (path, field) in &found.taken {
                    assert_eq!(field.name, files[path], "{}: {}", recorded.name, path.display());
                }
                assert_eq!(found.taken.len(), files.len(), "{}", recorded.name);
                looked_at += 1;
            }
        }
        assert!(looked_at > 20, "{looked_at}");
    }
}
