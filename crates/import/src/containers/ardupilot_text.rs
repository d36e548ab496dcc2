//! Logs of `ArduPilot` as text (`.log`), as ground stations write them: a message a line, its name and fields with commas
//! between, after lines `FMT` that tell the labels. What they hold is what the binary logs hold.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use super::Decoded;
use super::ardupilot::{Gathered, Imu};
use crate::damage::Fault;
use crate::error::Error;
use crate::options::Options;
use crate::part::Part;
use crate::text::Text;

/// How far from the beginning the first line `FMT` may be.
const BEGINNING: usize = 2000;
/// No message has more fields; a line that does is none.
const MOST_FIELDS: usize = 100;

/// Whether a text has a line that tells the labels of messages near its beginning.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
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
    // How many fields, and whose, by name.
    let mut known: BTreeMap<Vec<u8>, (usize, Option<Imu>)> = BTreeMap::new();
    let mut torn: Option<(usize, usize)> = None;
    for line in text.lines() {
        if let Some((number, bytes)) = torn.take() {
            gathered.losses.add(Fault::Torn, number, bytes);
        }
        let fields: Vec<_> = line
            .bytes
            .split(|&byte| byte == b',')
            .map(<[u8]>::trim_ascii)
            .take(MOST_FIELDS)
            .collect();
        let name = fields.first().copied().unwrap_or_default();
        if let [b"FMT", _, _, name, _, labels @ ..] = &fields[..] {
            let words: Vec<_> =
                labels.iter().map(|label| std::str::from_utf8(label).unwrap_or("")).collect();
            if let Entry::Vacant(slot) = known.entry(name.to_vec()) {
                let name = String::from_utf8_lossy(name);
                let imu = Imu::of(&name, &words);
                gathered.define(&name, imu.as_ref());
                slot.insert((1 + labels.len(), imu));
            }
        } else if let Some((width, imu)) = known.get(name) {
            let field = |place: usize| fast_float2::parse(fields.get(place + 1)?).ok();
            match imu.as_ref().map(|imu| imu.row(field).filter(|_| fields.len() == *width)) {
                Some(Some((sensor, row))) => gathered.sensor.push(sensor, line.number, row),
                Some(None) => torn = Some((line.number, line.bytes.len())),
                None => {}
            }
        } else if !known.is_empty() {
            torn = Some((line.number, line.bytes.len()));
        }
        if torn.is_none() {
            gathered.losses.read += line.bytes.len();
        }
    }
    if let Some((number, bytes)) = torn {
        gathered.losses.add(Fault::Cut, number, bytes);
    }
    gathered.decoded(Part::Line)
}
