//! Storage of the states on the disk, written atomically.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::keyed::{Fleet, Keyed};
use super::transport::Log;
use crate::{Error, output};

/// The name of the file.
const NAME: &str = "fleet.states";
/// The first bytes of the file.
const MAGIC: &[u8] = b"kestirim fleet 2\n";
const CHECKSUM: usize = size_of::<u32>();

/// The identity of the fleet that stored states belong to.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Owner {
    system: String,
    settings: Vec<String>,
    /// The snapshot of a fresh estimator, which covers anchor positions and all settings.
    fresh: Vec<u8>,
    /// The log that the states were computed from.
    log: Log,
}

/// A folder with the states of a fleet, locked for one program at a time.
#[derive(Debug)]
pub(super) struct Store {
    path: PathBuf,
    owner: Owner,
    _locked: File,
}

impl Store {
    /// Opens the folder and loads the stored states.
    ///
    /// # Errors
    /// If the folder is not available or in use by another program, or its contents are not states of this system with
    /// these settings and from this log. For a log that was created anew the states begin at its start.
    pub(super) fn open(
        folder: &Path,
        system: &str,
        settings: Vec<String>,
        log: Log,
        fleet: &mut Fleet,
    ) -> Result<Self, Error> {
        let failed = |path: &Path, source| Error::Write { path: path.to_path_buf(), source };
        fs::create_dir_all(folder).map_err(|source| failed(folder, source))?;
        let lock = folder.join("lock");
        let locked = File::create(&lock).map_err(|source| failed(&lock, source))?;
        locked.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => {
                let problem = "another program follows this fleet".to_owned();
                Error::File { path: folder.to_path_buf(), problem }
            }
            TryLockError::Error(source) => failed(&lock, source),
        })?;
        forget_drafts(folder).map_err(|source| failed(folder, source))?;
        let (system, fresh) = (system.to_owned(), fleet.fresh.clone());
        let owner = Owner { system, settings, fresh, log };
        let store = Self { path: folder.join(NAME), owner, _locked: locked };
        if let Some(keyed) = store.load()? {
            fleet.keyed = keyed;
        }
        Ok(store)
    }

    /// Writes all states and returns when they are on the disk.
    ///
    /// # Errors
    /// [`Error::Write`]; the previous states are then kept.
    pub(super) fn write(&self, keyed: &Keyed) -> Result<(), Error> {
        let failed = |error: postcard::Error| {
            let source = io::Error::other(error.to_string());
            Error::Write { path: self.path.clone(), source }
        };
        let mut bytes = MAGIC.to_vec();
        bytes.append(&mut postcard::to_allocvec(&(&self.owner, keyed)).map_err(failed)?);
        bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
        output::write_file(&self.path, |file| file.write_all(&bytes))
    }

    fn load(&self) -> Result<Option<Keyed>, Error> {
        let bytes = match fs::read(&self.path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(Error::Read { path: self.path.clone(), source }),
        };
        let refused =
            |problem: &str| Error::File { path: self.path.clone(), problem: problem.to_owned() };
        let whole = bytes.split_last_chunk::<CHECKSUM>();
        let whole = whole.filter(|(rest, sum)| crc32fast::hash(rest).to_le_bytes() == **sum);
        let states = whole.and_then(|(rest, _)| rest.strip_prefix(MAGIC));
        let states = states.ok_or_else(|| {
            refused(
                "these are no states of a fleet of this version; expected another folder (--state)",
            )
        })?;
        let (owner, mut keyed) = postcard::from_bytes::<(Owner, Keyed)>(states)
            .map_err(|_| refused("states of another version; expected another folder (--state)"))?;
        let (before, log) = (&owner.log, &self.owner.log);
        if before.name != log.name {
            let (before, now) = (&before.name, &log.name);
            return Err(refused(&format!(
                "states of what came from {before}; expected those from {now}, or another folder (--state)"
            )));
        }
        if before.created != log.created {
            output::warn(&format!(
                "warning: {} was made anew since its states were written: it is followed from its start",
                log.name
            ));
            keyed.position = 0;
        }
        if owner != (Owner { log: before.clone(), ..self.owner.clone() }) {
            let problem = "states of another system, or with other settings, files or version; expected another folder (--state)";
            return Err(refused(problem));
        }
        Ok(Some(keyed))
    }
}

/// Removes drafts left behind by a program that was killed while writing.
fn forget_drafts(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if name.starts_with(&format!(".{NAME}.")) {
            fs::remove_file(&path)?;
        }
    }
    Ok(())
}
