//! Satellite orbits: SP3-a, -b, -c and -d.

use std::path::Path;

use kestirim_gnss_ppp::GpsTime;

use super::fields::gps_satellite;
use super::lines::{Line, Text};
use super::satellites::PerSatellite;
use crate::Error;

/// What stands for a clock that is not known, µs.
const NO_CLOCK: f64 = 999_999.0;

/// Where a satellite was, in an earth-fixed frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrbitSample {
    /// When.
    pub time: GpsTime,
    /// Centre of mass, m.
    pub position: [f64; 3],
    /// What the satellite's clock is ahead of GPS time, s, without the relativity of its orbit's eccentricity.
    pub clock: Option<f64>,
    /// The clock jumped between the sample before and this one.
    pub clock_event: bool,
    /// The satellite was moved between the sample before and this one: nothing may be interpolated there.
    pub manoeuvre: bool,
}

/// Orbits of GPS satellites.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Orbits {
    samples: PerSatellite<OrbitSample>,
    /// What a user should know of the files.
    pub warnings: Vec<String>,
}

impl Orbits {
    /// Reads files in any order. Where two tell of the same instant, the one that begins later is believed.
    ///
    /// # Errors
    /// The file, the line, and what was expected there.
    pub fn read(paths: &[impl AsRef<Path>]) -> Result<Self, Error> {
        let texts: Result<Vec<_>, _> = paths.iter().map(|path| Text::read(path.as_ref())).collect();
        Self::parse(&texts?)
    }

    /// Reads files in memory, as [`Self::read`].
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(texts: &[Text]) -> Result<Self, Error> {
        let mut orbits = Self::default();
        let files: Result<Vec<_>, _> =
            texts.iter().map(|text| parse_file(text, &mut orbits.warnings)).collect();
        orbits.samples = PerSatellite::merge(
            files?,
            |sample| sample.time,
            |earlier, later| {
                later.clock = later.clock.or(earlier.clock);
                later.clock_event |= earlier.clock_event;
                later.manoeuvre |= earlier.manoeuvre;
            },
        );
        Ok(orbits)
    }

    /// The samples of a satellite in the order of time; none of one that the files do not know. Samples may
    /// be missing between others.
    pub fn satellite(&self, prn: u8) -> &[OrbitSample] {
        self.samples.of(prn)
    }

    /// The satellites there are.
    pub fn satellites(&self) -> impl Iterator<Item = u8> {
        self.samples.numbers()
    }
}

fn parse_file(text: &Text, warnings: &mut Vec<String>) -> Result<PerSatellite<OrbitSample>, Error> {
    let mut lines = text.lines();
    let first = lines.next().filter(|line| matches!(line.bytes, [b'#', b'a'..=b'd', ..]));
    let first = first.ok_or_else(|| text.wrong_kind("orbits (SP3)"))?;
    let mut samples = PerSatellite::default();
    let mut time = None;
    let mut time_system_known = false;
    let mut predicted = 0;
    let mut ended = false;
    while let Some(line) = lines.next() {
        if line.bytes.starts_with(b"EOF") {
            ended = true;
            break;
        }
        if lines.is_at_end() && !text.ends_with_line_break() {
            break;
        }
        match line.bytes {
            [b'P', name @ ..] => {
                let time = time.ok_or_else(|| line.expected("the time of an epoch"))?;
                if let Some(prn) = name.get(..3).and_then(gps_satellite) {
                    if let Some(sample) = position(&line, time)? {
                        samples.push(prn, sample);
                    }
                    predicted += usize::from(line.column(79) == b'P');
                } else if !matches!(name, [b'A'..=b'Z', _, b'0'..=b'9', ..]) {
                    return Err(line.expected("a satellite's position"));
                }
            }
            [b'*', ..] => time = Some(line.time([3, 7, 10, 13, 16, 19, 31])?),
            [b'%', b'c', ..] if !time_system_known => {
                time_system_known = true;
                time_system(&line)?;
            }
            [b'E', b'P' | b'V', ..] | [b'V' | b'#' | b'+' | b'%' | b'/', ..] => {}
            _ if line.bytes.trim_ascii().is_empty() => {}
            _ => return Err(line.expected("a record of an SP3 file")),
        }
    }
    if samples.is_empty() {
        return Err(first.error("expected orbits of GPS satellites, found none"));
    }
    if !ended {
        warnings.push(text.warning("has no EOF at its end: it may have been cut off"));
    }
    if predicted > 0 {
        let problem = format!("holds {predicted} predicted positions, worse than computed ones");
        warnings.push(text.warning(problem));
    }
    Ok(samples)
}

/// Times of Galileo and of QZSS are those of GPS to some nanoseconds.
fn time_system(line: &Line<'_>) -> Result<(), Error> {
    match line.columns(9, 12) {
        b"" | b"ccc" | b"GPS" | b"GAL" | b"QZS" => Ok(()),
        other => {
            let found = String::from_utf8_lossy(other);
            Err(line.error(format!("expected times of GPS, found the time system {found:?}")))
        }
    }
}

fn position(line: &Line<'_>, time: GpsTime) -> Result<Option<OrbitSample>, Error> {
    let mut position = [0.0; 3];
    for (i, coordinate) in position.iter_mut().enumerate() {
        *coordinate = 1e3 * line.finite("a position in km", 4 + 14 * i, 18 + 14 * i)?;
    }
    let clock = line.optional_number("a clock in µs", 46, 60)?;
    // Zeros stand for a position that is not known.
    let known = position.iter().any(|&coordinate| coordinate != 0.0);
    Ok(known.then(|| OrbitSample {
        time,
        position,
        clock: clock.filter(|clock| clock.abs() < NO_CLOCK).map(|clock| clock * 1e-6),
        clock_event: line.column(74) == b'E',
        manoeuvre: line.column(78) == b'M',
    }))
}
