//! Uploads from the page.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use axum::extract::multipart::Field;
use axum::http::StatusCode;
use sha2::{Digest, Sha256};
use tempfile::TempDir;
use tokio::sync::{Semaphore, SemaphorePermit};

use super::api::Refusal;

/// The maximum size of an upload in bytes. A day of satellites is some tens of megabytes, an hour of walking at 1 kHz
/// two hundred. A log takes four times its size of memory: none takes a gigabyte.
pub(super) const LARGEST: usize = 192 << 20;
/// The maximum number of uploads at once, as files are read in memory.
const AT_ONCE: usize = 2;

/// The folders of uploaded files.
pub(super) struct Uploads {
    /// The parent of all folders, so that none remains when the program ends.
    folder: PathBuf,
    permits: Semaphore,
}

impl Uploads {
    /// Uploads into folders below this one.
    pub(super) fn to(folder: &Path) -> Self {
        Self { folder: folder.to_path_buf(), permits: Semaphore::new(AT_ONCE) }
    }

    /// A new folder, deleted with the program at the latest.
    ///
    /// # Errors
    /// If the folder cannot be created.
    pub(super) fn folder(&self) -> Result<TempDir, Refusal> {
        TempDir::new_in(&self.folder).map_err(Refusal::of)
    }

    /// Reserves an upload and creates its folder.
    ///
    /// # Errors
    /// If the maximum number of uploads is already in progress.
    pub(super) fn begin(&self) -> Result<(SemaphorePermit<'_>, TempDir), Refusal> {
        let Ok(permit) = self.permits.try_acquire() else {
            let sentence = "two uploads are being read already: try again in a moment";
            return Err(Refusal(StatusCode::SERVICE_UNAVAILABLE, sentence.to_owned()));
        };
        Ok((permit, self.folder()?))
    }
}

/// The hash of an upload's contents, which is its name.
#[derive(Default)]
pub(super) struct Content(Sha256);

impl Content {
    /// Adds a field, a file's name or a text entered by the user. Its length is included, so that its end matters.
    pub(super) fn say(&mut self, text: &str) {
        self.0.update((text.len() as u64).to_le_bytes());
        self.0.update(text);
    }

    /// The first 128 bits of the hash, in hexadecimal digits.
    pub(super) fn name(self) -> String {
        let mut hash = kestirim_sweep::hex(&self.0.finalize());
        hash.truncate(32);
        hash
    }
}

/// Whether a recording's name is that of an upload.
pub(super) fn is_hash(name: &str) -> bool {
    name.len() == 32 && name.bytes().all(|byte| byte.is_ascii_hexdigit())
}

/// Writes a file as it arrives into its own subfolder `within` of `folder`, and returns its path.
pub(super) async fn write(
    folder: &Path,
    within: &str,
    mut part: Field<'_>,
    content: &mut Content,
) -> Result<PathBuf, Refusal> {
    // Only the file name: a browser may send a path, and the subfolder keeps files apart.
    let name = Path::new(part.file_name().unwrap_or_default()).file_name();
    let name = name.map_or_else(|| within.into(), ToOwned::to_owned);
    let field = within;
    let within = folder.join(within);
    let path = within.join(name);
    let create = || -> io::Result<File> {
        fs::create_dir_all(&within)?;
        File::create(&path)
    };
    let mut file = create().map_err(Refusal::of)?;
    content.say(field);
    content.say(&path.file_name().unwrap_or_default().to_string_lossy());
    let mut length = 0;
    while let Some(bytes) = part.chunk().await.map_err(Refusal::of)? {
        length += bytes.len() as u64;
        content.0.update(&bytes);
        file.write_all(&bytes).map_err(Refusal::of)?;
    }
    content.0.update(length.to_le_bytes());
    Ok(path)
}
