//! Decompression of pieces of a file.
//!
//! LZ4 is decompressed by `lz4_flex`, Zstandard by `ruzstd`, bz2 by `bzip2-rs`, all in pure Rust; they take little more
//! memory than their output. Considered for bz2: `bzip2` 0.6, which is newer and faster, has a licence of its own.

use std::borrow::Cow;
use std::io::Read;

use bzip2_rs::DecoderReader;
use lz4_flex::frame::FrameDecoder;
use ruzstd::decoding::StreamingDecoder;

use super::LARGEST;
use crate::error::Error;

/// The compression of a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Compression {
    None,
    Bz2,
    Lz4,
    Zstd,
}

impl Compression {
    /// The compression with this name in a file.
    pub(super) fn of(name: &[u8]) -> Option<Self> {
        match name {
            b"" | b"none" => Some(Self::None),
            b"bz2" => Some(Self::Bz2),
            b"lz4" => Some(Self::Lz4),
            b"zstd" => Some(Self::Zstd),
            _ => None,
        }
    }
}

/// The number of bytes that may still be unpacked.
#[derive(Debug)]
pub(super) struct Budget(u64);

impl Default for Budget {
    fn default() -> Self {
        Self(LARGEST)
    }
}

impl Budget {
    /// Unpacks a piece as far as possible, up to the announced size.
    ///
    /// # Errors
    /// If all pieces together are too large.
    pub(super) fn unpack<'a>(
        &mut self,
        compression: Compression,
        packed: &'a [u8],
        size: u64,
    ) -> Result<Cow<'a, [u8]>, Error> {
        if compression == Compression::None {
            return Ok(Cow::Borrowed(packed));
        }
        self.0 = self.0.checked_sub(size).ok_or_else(super::too_large)?;
        let mut unpacked = Vec::new();
        let mut rest = packed;
        // A piece may hold several frames.
        while (unpacked.len() as u64) < size && !rest.is_empty() {
            let (before, left) = (unpacked.len(), size - unpacked.len() as u64);
            // The output before an error is right as far as it goes; the size tells that more is missing.
            match compression {
                Compression::Zstd => match StreamingDecoder::new(&mut rest) {
                    Ok(frame) => drop(frame.take(left).read_to_end(&mut unpacked)),
                    Err(_) => break,
                },
                Compression::Bz2 => {
                    drop(DecoderReader::new(&mut rest).take(left).read_to_end(&mut unpacked));
                }
                _ => drop(FrameDecoder::new(&mut rest).take(left).read_to_end(&mut unpacked)),
            }
            if unpacked.len() == before {
                break;
            }
        }
        Ok(Cow::Owned(unpacked))
    }
}
