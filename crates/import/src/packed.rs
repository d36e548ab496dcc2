//! Logs packed with gzip.

use std::borrow::Cow;
use std::io::{ErrorKind, Read};

use flate2::read::MultiGzDecoder;

use crate::error::Error;

/// The largest size to which a log may unpack, bytes.
const LARGEST: u64 = 1 << 30;

/// The contents of a file, unpacked if it is packed with gzip. A folder packed with zip, as phones write it, is left to its reader.
///
/// # Errors
/// [`Error::Log`] if it is damaged, unpacks to more than 1 GiB, or is packed in another way.
pub fn unpacked(bytes: Cow<'_, [u8]>) -> Result<Cow<'_, [u8]>, Error> {
    let other = match *bytes {
        [0x1f, 0x8b, ..] => return gunzip(&bytes).map(Cow::Owned),
        [b'B', b'Z', b'h', b'1'..=b'9', ..] => "bzip2",
        [0xfd, b'7', b'z', b'X', b'Z', ..] => "xz",
        [0x28, 0xb5, 0x2f, 0xfd, ..] => "zstd",
        [b'7', b'z', 0xbc, 0xaf, ..] => "7-Zip",
        _ => return Ok(bytes),
    };
    Err(Error::log(format!("expected a log, found a file packed with {other}: unpack it first")))
}

fn gunzip(packed: &[u8]) -> Result<Vec<u8>, Error> {
    let mut unpacked = Vec::new();
    let read = MultiGzDecoder::new(packed).take(LARGEST + 1).read_to_end(&mut unpacked);
    match read {
        Ok(_) if unpacked.len() as u64 > LARGEST => {
            Err(Error::log("unpacks to more than 1 GiB, which no log of use does"))
        }
        Ok(_) => Ok(unpacked),
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => {
            Err(Error::log("is a gzip file that was cut off"))
        }
        Err(error) => Err(Error::log(format!("is a damaged gzip file: {error}"))),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

    #[test]
    fn gzip_is_unpacked_and_others_are_named() {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(b"t,x\n0,1\n").unwrap();
        let packed = encoder.finish().unwrap();
        let of = |bytes: &[u8]| unpacked(Cow::Borrowed(bytes)).map(Cow::into_owned);
        assert_eq!(of(&packed).unwrap(), b"t,x\n0,1\n");
        assert_eq!(of(&packed.repeat(2)).unwrap(), b"t,x\n0,1\nt,x\n0,1\n");
        assert_eq!(of(b"t,x\n").unwrap(), b"t,x\n");
        let sentence = |bytes: &[u8]| of(bytes).unwrap_err().to_string();
        assert_eq!(sentence(&packed[..packed.len() - 9]), "is a gzip file that was cut off");
        assert!(sentence(b"\x1f\x8bno").starts_with("is a "));
        assert!(sentence(b"BZh91AY").contains("bzip2: unpack it first"));
    }
}
