//! Reading of files into memory, and unpacking of gzip.

use std::fs::{self, File};
use std::io::{self, BufRead, Read};
use std::path::Path;

use flate2::bufread::GzDecoder;

use crate::error::Error;

/// The largest size to which a file may unpack, bytes.
pub(crate) const LARGEST: usize = 1 << 30;

/// Reads a file.
///
/// # Errors
/// [`Error::Read`] if it cannot be read, [`Error::File`] if it is too large.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    let open = || match fs::metadata(path)? {
        // A pipe or device may never end, or never begin.
        file if !(file.is_file() || file.is_dir()) => {
            Err(io::Error::other("it is a pipe or a device, not a file"))
        }
        _ => File::open(path),
    };
    let read = open().and_then(|file| {
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

/// Whether a file begins as gzip files do.
pub(crate) fn is_packed(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}

/// Unpacks a file if it is packed.
///
/// # Errors
/// [`Error::File`] if it cannot be unpacked.
pub(crate) fn unpack(path: &Path, bytes: Vec<u8>) -> Result<Vec<u8>, Error> {
    let error = |problem: String| Error::File { path: path.to_path_buf(), problem };
    let refused = match &*bytes {
        _ if is_packed(&bytes) => return gunzip(&bytes).map_err(error),
        [0x1f, 0x9d, ..] => "compress (.Z): unpack it with gzip -d first",
        [b'P', b'K', 3, 4, ..] => "zip: unpack it first",
        [b'B', b'Z', b'h', ..] => "bzip2: unpack it first",
        [0xfd, b'7', b'z', b'X', b'Z', ..] => "xz: unpack it first",
        _ => return Ok(bytes),
    };
    Err(error(format!("expected plain text or gzip, found a file packed with {refused}")))
}

/// Unpacks the members of a gzip file one after the other; trailing data that is no member is ignored, as gzip does.
fn gunzip(packed: &[u8]) -> Result<Vec<u8>, String> {
    let mut rest = packed;
    let mut unpacked = Vec::with_capacity(packed.len().saturating_mul(5).min(LARGEST));
    while is_packed(rest) {
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

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

    fn packed(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(bytes).and_then(|()| encoder.finish()).expect("memory can be written")
    }

    fn unpacked(bytes: Vec<u8>) -> Result<Vec<u8>, String> {
        unpack(Path::new("file"), bytes).map_err(|error| error.to_string())
    }

    #[test]
    fn members_are_put_together() {
        let mut file = packed(b"one ");
        file.extend(packed(b"two"));
        assert_eq!(unpacked(file.clone()).as_deref(), Ok(&b"one two"[..]));
        // Tapes and some programs fill up with zeros.
        file.extend([0; 512]);
        assert_eq!(unpacked(file).as_deref(), Ok(&b"one two"[..]));
        assert_eq!(unpacked(b"one".to_vec()).as_deref(), Ok(&b"one"[..]));
    }

    #[test]
    fn damage_is_one_sentence() {
        let mut file = packed(&[b'a'; 1000]);
        let sentence = unpacked(file[..file.len() - 9].to_vec()).unwrap_err();
        assert_eq!(sentence, "file: is a gzip file that was cut off");
        let middle = file.len() / 2;
        file[middle] ^= 0xff;
        let sentence = unpacked(file).unwrap_err();
        assert!(sentence.starts_with("file: is a damaged gzip file: "), "{sentence}");
        assert!(unpacked(b"\x1f\x8b".to_vec()).is_err());
    }

    #[test]
    fn other_packings_are_named() {
        let sentence = unpacked(b"\x1f\x9d\x90".to_vec()).unwrap_err();
        assert!(sentence.ends_with("compress (.Z): unpack it with gzip -d first"), "{sentence}");
        assert!(unpacked(b"PK\x03\x04".to_vec()).unwrap_err().contains("zip"));
    }

    #[test]
    fn what_unpacks_to_too_much_is_refused() {
        // A file of many members: four mebibytes of zeros in each.
        let member = packed(&vec![0; 1 << 22]);
        let sentence = unpacked(member.repeat(257)).unwrap_err();
        assert!(sentence.contains("more than 1 GiB"), "{sentence}");
    }

    #[test]
    fn a_file_that_is_not_there_is_told() {
        let error = read(Path::new("no/such/file")).unwrap_err();
        assert!(matches!(error, Error::Read { .. }));
    }
}
