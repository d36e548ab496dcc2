//! Formats told apart by their first line.

use crate::error::quoted;

/// The format of a text in words, by its first line.
pub(crate) fn kind(bytes: &[u8]) -> String {
    const RINEX: &[u8] = b"RINEX VERSION / TYPE";
    let first = bytes.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let start = first.trim_ascii_start();
    let named = |label: &[u8]| memchr::memmem::find(first, label).is_some();
    let name = match first {
        [] if bytes.is_empty() => "an empty file",
        _ if named(RINEX) => match first.get(20).filter(|byte| **byte != b' ').or(first.get(21)) {
            Some(b'O') => "observations (RINEX)",
            Some(b'N' | b'G' | b'E' | b'H' | b'L') => "a navigation file (RINEX)",
            Some(b'M') => "a meteorological file (RINEX)",
            Some(b'C') => "satellite clocks (RINEX)",
            _ => "a RINEX file of another type",
        },
        _ if named(b"ANTEX VERSION") => "antenna patterns (ANTEX)",
        _ if named(b"IONEX VERSION") => "an ionosphere map (IONEX)",
        [b'#', b'a'..=b'd', b'P' | b'V', ..] => "orbits (SP3)",
        _ if first.starts_with(b"%=BIA") => "biases (Bias-SINEX)",
        _ if start.starts_with(b"$$") => "ocean loading (BLQ)",
        _ if start.starts_with(b"<") => "a web page: the download did not work",
        _ => return quoted(first),
    };
    name.to_owned()
}
