//! Files that the page sends.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use axum::extract::multipart::Field;
use axum::http::StatusCode;
use tempfile::TempDir;
use tokio::sync::{Semaphore, SemaphorePermit};

use super::api::Refusal;

/// A day of satellites is some tens of megabytes, an hour of walking at 1 kHz two hundred. A log takes four times its size of
/// memory: none takes a gigabyte.
pub(super) const LARGEST: usize = 192 << 20;
/// Files are read in memory.
const AT_ONCE: usize = 2;

/// Where files lie while they are read.
pub(super) struct Uploads {
    /// All of them are below it, so that none stays when the program ends.
    folder: PathBuf,
    permits: Semaphore,
}

impl Uploads {
    /// Into folders below this one.
    pub(super) fn to(folder: &Path) -> Self {
        Self { folder: folder.to_path_buf(), permits: Semaphore::new(AT_ONCE) }
    }

    /// A turn to send files.
    ///
    /// # Errors
    /// If as many as may be are being sent already.
    pub(super) fn begin(&self) -> Result<(SemaphorePermit<'_>, TempDir), Refusal> {
        let Ok(permit) = self.permits.try_acquire() else {
            let sentence = "two uploads are being read already: try again in a moment";
            return Err(Refusal(StatusCode::SERVICE_UNAVAILABLE, sentence.to_owned()));
        };
        Ok((permit, TempDir::new_in(&self.folder).map_err(Refusal::of)?))
    }
}

/// Writes a file as it comes; where it lies.
pub(super) async fn write(folder: &Path, mut part: Field<'_>) -> Result<PathBuf, Refusal> {
    let field = part.name().unwrap_or_default().to_owned();
    // The name alone: what a browser sends may hold a path, and it is told apart from others by its field.
    let name = Path::new(part.file_name().unwrap_or_default()).file_name();
    let name = name.map_or_else(|| field.clone().into(), ToOwned::to_owned);
    let within = folder.join(&field);
    let path = within.join(name);
    let create = || -> io::Result<File> {
        fs::create_dir_all(&within)?;
        File::create(&path)
    };
    let mut file = create().map_err(Refusal::of)?;
    while let Some(bytes) = part.chunk().await.map_err(Refusal::of)? {
        file.write_all(&bytes).map_err(Refusal::of)?;
    }
    Ok(path)
}
