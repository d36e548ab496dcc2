//! Files in a zip file.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use zip::ZipArchive;
use zip::result::ZipError;

use crate::text::file_name;

/// The maximum total size to unpack, in bytes.
const LARGEST: u64 = 1 << 30;
/// The maximum number of files to unpack.
const MOST: usize = 500;

/// Whether a file begins with the signature of zip files.
pub(super) fn is_zip(path: &Path) -> bool {
    let mut start = [0; 4];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut start));
    read.is_ok() && start == *b"PK\x03\x04"
}

/// Unpacks all files, each into its own folder below `folder`, and returns their paths. Hidden files, and those that
/// macOS adds, are left out.
///
/// # Errors
/// One sentence, if the archive is damaged or too large.
pub(super) fn unpack(path: &Path, folder: &Path) -> Result<Vec<PathBuf>, String> {
    let name = file_name(path);
    let damaged =
        |error: ZipError| format!("{name}: expected a whole zip file, found one with {error}");
    // The folder of the archive itself is named after its number.
    let own = path.parent().and_then(Path::file_name).unwrap_or_default().to_string_lossy();
    let file = File::open(path).map_err(|error| format!("{name}: {error}"))?;
    let mut archive = ZipArchive::new(file).map_err(damaged)?;
    if archive.len() > MOST {
        return Err(format!("{name}: expected at most {MOST} files, found {}", archive.len()));
    }
    let (mut paths, mut left) = (Vec::new(), LARGEST);
    for index in 0..archive.len() {
        let mut file = archive.by_index(index).map_err(damaged)?;
        let Some(inner) = file.enclosed_name().filter(|inner| file.is_file() && is_real(inner))
        else {
            continue;
        };
        let within = folder.join(format!("{own}-{index}"));
        let to = within.join(inner.file_name().unwrap_or_default());
        let written = fs::create_dir(&within)
            .and_then(|()| File::create(&to))
            .and_then(|mut out| io::copy(&mut (&mut file).take(left + 1), &mut out));
        let length = written.map_err(|error| format!("{name}: {error}"))?;
        left = left.checked_sub(length).ok_or_else(|| {
            format!("{name}: it unpacks to more than 1 GiB, which no recording does")
        })?;
        paths.push(to);
    }
    Ok(paths)
}

fn is_real(inner: &Path) -> bool {
    !inner.iter().any(|part| part == "__MACOSX" || part.to_string_lossy().starts_with('.'))
}
