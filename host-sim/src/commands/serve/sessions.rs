//! Open recordings, and the files from which they can be opened again.

use std::collections::VecDeque;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tempfile::TempDir;

use super::api::Refusal;
use super::uploads::is_hash;
use crate::Error;
use crate::system::{AnySystem, Files, Opened, Settings, Source};

/// The maximum number of open recordings: as many as a person compares, as a day of satellites is large.
const MOST_OPEN: usize = 8;
/// The maximum number of uploads whose files are kept.
const MOST_KEPT: usize = 8;

/// The most recently used recordings and uploads.
#[derive(Default)]
pub(super) struct Sessions {
    open: Mutex<VecDeque<(Name, Recording)>>,
    uploads: Mutex<VecDeque<(Name, Upload)>>,
}

/// A system and the identifier of its recording in the address: the name of a synthetic one, or the hash of an upload.
pub(super) type Name = (&'static str, String);

/// An open recording.
#[derive(Clone)]
pub(super) struct Recording {
    pub(super) opened: Arc<dyn Opened>,
    /// The folder of its files, which is not revealed to the page.
    folder: Option<Arc<TempDir>>,
    /// The names of its files, for people; `None` for a synthetic recording.
    pub(super) files: Option<String>,
}

impl Recording {
    /// The folder of its files, if it has any.
    pub(super) fn folder(&self) -> Option<&Path> {
        self.folder.as_deref().map(TempDir::path)
    }

    /// Renames the files in an error to the names that they were uploaded with.
    pub(super) fn naming_files(&self, error: Error) -> Error {
        match self.folder() {
            Some(folder) => error.naming_files_below(folder),
            None => error,
        }
    }
}

/// Files uploaded by the page.
#[derive(Clone)]
pub(super) struct Upload {
    pub(super) files: Files,
    pub(super) folder: Arc<TempDir>,
}

impl Upload {
    /// The recording of these files.
    pub(super) fn opened(&self, opened: Box<dyn Opened>) -> Recording {
        let names = self.files.paths().filter_map(|path| path.file_name());
        let names: Vec<_> = names.map(|name| name.to_string_lossy()).collect();
        let (folder, files) = (Some(Arc::clone(&self.folder)), Some(names.join(", ")));
        Recording { opened: Arc::from(opened), folder, files }
    }
}

impl Sessions {
    /// Keeps a recording, and closes the least recently used one if there are too many.
    pub(super) fn add(&self, name: Name, recording: Recording) {
        put(&mut lock(&self.open), name, recording, MOST_OPEN);
    }

    /// Keeps files, so that their recording can be opened again.
    pub(super) fn keep(&self, name: Name, upload: Upload) {
        put(&mut lock(&self.uploads), name, upload, MOST_KEPT);
    }

    /// The recording of this name, opened again if necessary.
    ///
    /// # Errors
    /// If there is no recording of this name, or no longer.
    pub(super) fn get(
        &self,
        system: &'static dyn AnySystem,
        recording: &str,
    ) -> Result<Recording, Refusal> {
        let name = (system.name(), recording.to_owned());
        let upload = take(&mut lock(&self.uploads), &name);
        let open = take(&mut lock(&self.open), &name);
        // The other recordings drop their large answers.
        let others = lock(&self.open).clone();
        others
            .iter()
            .filter(|(other, _)| *other != name)
            .for_each(|(_, other)| other.opened.forget_large());
        if let Some(open) = open {
            return Ok(open);
        }
        let source = match &upload {
            Some(upload) => Source::Files(upload.files.clone()),
            None if is_hash(recording) => return Err(Refusal::gone()),
            None => Source::Synthetic(recording.to_owned()),
        };
        let settings = Settings::new(system.settings());
        let opened = system.open(source, &settings).map_err(|error| match &upload {
            Some(upload) => error.naming_files_below(upload.folder.path()),
            None => error,
        })?;
        let recording = match upload {
            Some(upload) => upload.opened(opened),
            None => Recording { opened: Arc::from(opened), folder: None, files: None },
        };
        self.add(name, recording.clone());
        Ok(recording)
    }
}

/// Inserts a value as the most recently used one.
fn put<T>(all: &mut VecDeque<(Name, T)>, name: Name, value: T, most: usize) {
    all.retain(|(known, _)| *known != name);
    all.push_back((name, value));
    if all.len() > most {
        all.pop_front();
    }
}

fn take<T: Clone>(all: &mut VecDeque<(Name, T)>, name: &Name) -> Option<T> {
    let place = all.iter().position(|(known, _)| known == name)?;
    let latest = all.remove(place)?;
    let value = latest.1.clone();
    all.push_back(latest);
    Some(value)
}

fn lock<T>(all: &Mutex<T>) -> MutexGuard<'_, T> {
    // A panic in another thread cannot leave the contents inconsistent.
    all.lock().unwrap_or_else(PoisonError::into_inner)
}
