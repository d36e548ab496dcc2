//! Logs of `ArduPilot` as text (`.log`), as ground stations write them: a message a line, its name and fields with commas
//! between, after lines `FMT` that tell the labels. What they hold is what the binary logs hold.

use super::Decoded;
use super::ardupilot::{Gathered, Imu};
use crate::damage::Fault;
use crate::error::Error;
use crate::options::Options;
use crate::part::Part;
use crate::text::Text;

/// How far from the beginning the first line `FMT` may be.
const BEGINNING: usize = 2000;

/// Whether a text has a line that tells the labels of messages near its beginning.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    let beginning = bytes.get(..BEGINNING).unwrap_or(bytes);
    let mut lines = beginning.split(|&byte| byte == b'\n' || byte == b'\r');
    lines.any(|line| line.starts_with(b"FMT, ") || line.starts_with(b"FMT,1"))
}

/// Reads a log of text.
///
/// # Errors
/// If it holds no inertial sensor, or not the one that is wanted.
pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Decoded, Error> {
    let text = Text::new(bytes)?;
    let mut gathered = Gathered::new(options)?;
    let mut known: Vec<(String, usize, Option<Imu>)> = Vec::new();
    let mut torn: Option<(usize, usize)> = None;
    for line in text.lines() {
        if let Some((number, bytes)) = torn.take() {
            gathered.losses.add(Fault::Torn, number, bytes);
        }
        let fields: Vec<_> =
            line.bytes.split(|&byte| byte == b',').map(<[u8]>::trim_ascii).collect();
        let name = fields.first().copied().unwrap_or_default();
        if let [b"FMT", _, _, name, _, labels @ ..] = &fields[..] {
            let words: Vec<_> =
                labels.iter().filter_map(|label| std::str::from_utf8(label).ok()).collect();
            let name = String::from_utf8_lossy(name).into_owned();
            let imu = Imu::of(&name, &words);
            if !known.iter().any(|(known, ..)| *known == name) {
                gathered.define(&name, imu.as_ref());
                known.push((name, 1 + labels.len(), imu));
            }
        } else if let Some((_, width, imu)) =
            known.iter().find(|(known, ..)| known.as_bytes() == name)
        {
            let Some(imu) = imu else {
                gathered.losses.read += line.bytes.len();
                continue;
            };
            let field = |place: usize| fast_float2::parse(fields.get(place + 1)?).ok();
            match imu.row(field).filter(|_| fields.len() == *width) {
                Some((sensor, row)) => gathered.sensor.push(sensor, line.number, row),
                None => torn = Some((line.number, line.bytes.len())),
            }
        } else if !known.is_empty() {
            torn = Some((line.number, line.bytes.len()));
            continue;
        }
        gathered.losses.read += line.bytes.len();
    }
    if let Some((number, bytes)) = torn {
        gathered.losses.add(Fault::Cut, number, bytes);
    }
    gathered.decoded(Part::Line)
}
