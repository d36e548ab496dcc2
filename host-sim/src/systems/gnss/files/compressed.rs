//! Unpacking.

use std::fs::File;
use std::io::{self, BufRead, Read};
use std::path::Path;

use flate2::bufread::GzDecoder;

use crate::Error;

/// No file of any use unpacks to more, bytes.
pub(super) const LARGEST: usize = 1 << 30;

/// Reads a file.
///
/// # Errors
/// [`Error::Read`] if it cannot be read, [`Error::File`] if it is too large.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| {
        bytes.reserve(file.metadata()?.len().min(LARGEST as u64) as usize);
        file.take(LARGEST as u64 + 1).read_to_end(&mut bytes)
    });
    read.map_err(|source| Error::Read { path: path.to_path_buf(), source })?;
    if bytes.len() > LARGEST {
        let problem = "is larger than 1 GiB, which no file of use is".to_owned();
        return Err(Error::File { path: path.to_path_buf(), problem });
    }
    Ok(bytes)
}

/// Unpacks what is packed.
///
/// # Errors
/// [`Error::File`] if it cannot be unpacked.
pub(super) fn unpack(path: &Path, bytes: Vec<u8>) -> Result<Vec<u8>, Error> {
    let complaint = |problem: String| Error::File { path: path.to_path_buf(), problem };
    let refused = match &*bytes {
        [0x1f, 0x8b, ..] => return gunzip(&bytes).map_err(complaint),
        [0x1f, 0x9d, ..] => "compress (.Z): unpack it with gzip -d first",
        [b'P', b'K', 3, 4, ..] => "zip: unpack it first",
        [b'B', b'Z', b'h', ..] => "bzip2: unpack it first",
        [0xfd, b'7', b'z', b'X', b'Z', ..] => "xz: unpack it first",
        _ => return Ok(bytes),
    };
    Err(complaint(format!("expected plain text or gzip, found a file packed with {refused}")))
}

/// Unpacks the members of a gzip file, one after the other; what follows them and is none is left out, as
/// gzip does.
fn gunzip(packed: &[u8]) -> Result<Vec<u8>, String> {
    let mut rest = packed;
    let mut unpacked = Vec::with_capacity(packed.len().saturating_mul(5).min(LARGEST));
    while rest.starts_with(&[0x1f, 0x8b]) {
        let left = (LARGEST - unpacked.len()) as u64;
        let mut decoder = GzDecoder::new(&mut rest);
        let read = decoder.by_ref().take(left + 1).read_to_end(&mut unpacked);
        read.map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => "is a gzip file that was cut off".to_owned(),
            _ => format!("is a damaged gzip file: {error}"),
        })?;
        if unpacked.len() > LARGEST {
            return Err("unpacks to more than 1 GiB, which no file of use does".to_owned());
        }
        // At the end of the member already.
        let _ = rest.fill_buf();
    }
    Ok(unpacked)
}
