//! Detection of formats by their first line.

use std::fmt;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use flate2::bufread::GzDecoder;
use kestirim_gnss_message::ssr;

use crate::earth_rotation::is_earth_rotation;
use crate::error::{Error, quoted};
use crate::text::without_mark;
use crate::{crinex, gzip, streams};

/// How much of a file is read, bytes: enough for the first line, packed or not.
const BEGINNING: u64 = 4096;

/// The kind of a file, according to its first line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// A receiver's observations: RINEX or Compact RINEX.
    Observations,
    /// Ephemerides broadcast by satellites: RINEX.
    Navigation,
    /// Weather at a station: RINEX.
    Meteorology,
    /// Clocks of satellites: RINEX.
    Clocks,
    /// A RINEX file of another type.
    OtherRinex,
    /// Antenna patterns: ANTEX.
    Antennas,
    /// A map of the ionosphere: IONEX.
    Ionosphere,
    /// Orbits: SP3.
    Orbits,
    /// Biases of codes and phases: Bias-SINEX.
    Biases,
    /// Ocean loading of stations: BLQ.
    OceanLoading,
    /// The Earth's rotation: ERP.
    EarthRotation,
    /// A receiver's stream of observations and usually ephemerides: UBX.
    Ubx,
    /// A reference station's stream of observations and usually ephemerides: RTCM 3.
    Rtcm,
    /// A service's stream, which begins with corrections of ephemerides: RTCM 3.
    Corrections,
}

impl Kind {
    /// The kind of a file, plain or packed with gzip; `None` if its first line is of no format that this crate knows.
    ///
    /// # Errors
    /// [`Error::Read`] if the file cannot be read.
    pub fn of_file(path: impl AsRef<Path>) -> Result<Option<Self>, Error> {
        let path = path.as_ref();
        let mut bytes = Vec::new();
        File::open(path)
            .and_then(|file| file.take(BEGINNING).read_to_end(&mut bytes))
            .map_err(|source| Error::Read { path: path.to_path_buf(), source })?;
        if !gzip::is_packed(&bytes) {
            return Ok(Self::of(&bytes));
        }
        let mut unpacked = Vec::new();
        // The bytes read end within the file: what can be unpacked of them is its beginning.
        let _ = GzDecoder::new(&*bytes).take(BEGINNING).read_to_end(&mut unpacked);
        Ok(Self::of(&unpacked))
    }

    /// Whether it is a recorded stream, UBX or RTCM 3, which may contain ephemerides.
    pub const fn is_stream(self) -> bool {
        matches!(self, Self::Ubx | Self::Rtcm | Self::Corrections)
    }

    /// The kind of unpacked contents, or of their beginning; `None` if they are of no format that this crate knows.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let bytes = without_mark(bytes);
        let first = bytes.split(|&byte| byte == b'\n').next().unwrap_or_default();
        let named = |label: &[u8]| memchr::memmem::find(first, label).is_some();
        if named(b"RINEX VERSION / TYPE") {
            let letter = first.get(20).filter(|byte| **byte != b' ').or(first.get(21));
            return Some(match letter {
                Some(b'O') => Self::Observations,
                Some(b'N' | b'G' | b'E' | b'H' | b'L') => Self::Navigation,
                Some(b'M') => Self::Meteorology,
                Some(b'C') => Self::Clocks,
                _ => Self::OtherRinex,
            });
        }
        match first {
            _ if crinex::is_compressed(first) => Some(Self::Observations),
            _ if named(b"ANTEX VERSION") => Some(Self::Antennas),
            _ if named(b"IONEX VERSION") => Some(Self::Ionosphere),
            [b'#', b'a'..=b'd', b'P' | b'V', ..] => Some(Self::Orbits),
            _ if first.starts_with(b"%=BIA") => Some(Self::Biases),
            _ if first.trim_ascii_start().starts_with(b"$$") => Some(Self::OceanLoading),
            _ if is_earth_rotation(first) => Some(Self::EarthRotation),
            _ if streams::is_ubx(bytes) => Some(Self::Ubx),
            _ => streams::first_of_rtcm(bytes).map(|data| match ssr::Message::from_data(data) {
                Some(_) => Self::Corrections,
                None => Self::Rtcm,
            }),
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Observations => "observations (RINEX)",
            Self::Navigation => "a navigation file (RINEX)",
            Self::Meteorology => "a meteorological file (RINEX)",
            Self::Clocks => "satellite clocks (RINEX)",
            Self::OtherRinex => "a RINEX file of another type",
            Self::Antennas => "antenna patterns (ANTEX)",
            Self::Ionosphere => "an ionosphere map (IONEX)",
            Self::Orbits => "orbits (SP3)",
            Self::Biases => "biases (Bias-SINEX)",
            Self::OceanLoading => "ocean loading (BLQ)",
            Self::EarthRotation => "Earth rotation (ERP)",
            Self::Ubx => "a receiver's stream (UBX)",
            Self::Rtcm => "the stream of a reference station (RTCM 3)",
            Self::Corrections => "a stream of corrections (SSR in RTCM 3)",
        })
    }
}

/// The format of a text in words, according to its first line.
pub(crate) fn in_words(bytes: &[u8]) -> String {
    let first = bytes.split(|&byte| byte == b'\n').next().unwrap_or_default();
    match Kind::of(bytes) {
        Some(kind) => kind.to_string(),
        None if bytes.is_empty() => "an empty file".to_owned(),
        None if first.trim_ascii_start().starts_with(b"<") => {
            "a web page: the download did not work".to_owned()
        }
        None => quoted(first),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

    #[test]
    fn a_file_tells_its_kind_packed_or_not() -> Result<(), Box<dyn std::error::Error>> {
        let orbits = format!("#dP2020  6 25  0  0  0.00000000\n{}", "## 1\n".repeat(100_000));
        let cases: [(&[u8], Option<Kind>); 5] = [
            (orbits.as_bytes(), Some(Kind::Orbits)),
            (b"%=BIA 1.00 COD\n", Some(Kind::Biases)),
            (b"\xef\xbb\xbf%=BIA 1.00 COD\n", Some(Kind::Biases)),
            (b"t,x,y\n0,1,2\n", None),
            (b"", None),
        ];
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("file");
        for (text, kind) in cases {
            std::fs::write(&path, text)?;
            assert_eq!(Kind::of_file(&path)?, kind);
            let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
            encoder.write_all(text)?;
            std::fs::write(&path, encoder.finish()?)?;
            assert_eq!(Kind::of_file(&path)?, kind);
        }
        assert!(Kind::of_file(folder.path().join("none")).is_err());
        Ok(())
    }
}
