//! Observations: RINEX 2.x, 3.0x and 4.0x.

mod header;
mod signals;

use std::collections::BTreeMap;
use std::path::Path;

use kestirim_gnss_ppp::GpsTime;

use self::header::Header;
use self::signals::{Raw, Seen};
pub use self::signals::{Signal, Signals};
use super::fields::gps_satellite;
use super::lines::{Line, Lines, Text};
use super::time::full_year;
use crate::Error;

/// What a receiver observed of GPS satellites.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Observations {
    /// The station's name.
    pub marker: String,
    /// The receiver's type.
    pub receiver: String,
    /// Type and radome of the antenna in 20 columns, as an ANTEX file names it.
    pub antenna: String,
    /// Where the marker is, to some metres: ECEF, m.
    pub approximate_position: Option<[f64; 3]>,
    /// The antenna's reference point above, east and north of the marker, m.
    pub antenna_delta_hen: [f64; 3],
    /// In the order of time.
    pub epochs: Vec<Epoch>,
    /// What was taken from each satellite's signals, by its number.
    pub signals: BTreeMap<u8, Signals>,
    /// What a user should know of the file.
    pub warnings: Vec<String>,
}

/// Observations of one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Epoch {
    /// By the receiver's clock.
    pub time: GpsTime,
    /// The receiver was without power since the epoch before.
    pub power_failure: bool,
    /// In the order of the file.
    pub satellites: Vec<Observed>,
}

/// Observations of one satellite, on L1 and L2.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Observed {
    /// The satellite.
    pub prn: u8,
    /// Pseudoranges, m.
    pub code: [Option<f64>; 2],
    /// Carrier phases, cycles.
    pub phase: [Option<f64>; 2],
    /// The receiver lost the phase since the epoch before.
    pub loss_of_lock: [bool; 2],
}

impl Observations {
    /// Reads a file.
    ///
    /// # Errors
    /// The file, the line, and what was expected there.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Self::parse(&Text::read(path)?)
    }

    /// Reads a file in memory.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(text: &Text) -> Result<Self, Error> {
        let mut lines = text.lines();
        let header = Header::parse(text, &mut lines)?;
        let mut body = Body { header, ..Body::default() };
        body.read(text, &mut lines)?;
        Ok(body.finish(text))
    }
}

/// The columns of an epoch's time, flag and count.
const EPOCH_2: [usize; 7] = [1, 3, 6, 9, 12, 15, 26];
const EPOCH_3: [usize; 7] = [2, 6, 9, 12, 15, 18, 29];

/// What a file holds, with all the signals it tells of.
#[derive(Debug, Default)]
struct Body {
    header: Header,
    epochs: Vec<RawEpoch>,
    /// Of all epochs, one after the other: satellite, and the end of its part of `raw`.
    records: Vec<(u8, usize)>,
    raw: Vec<Raw>,
    seen: Seen,
    backwards: usize,
    doubled: usize,
    warnings: Vec<String>,
}

#[derive(Debug)]
struct RawEpoch {
    time: GpsTime,
    power_failure: bool,
    /// The end of its part of the records.
    end: usize,
}

impl Body {
    fn read<'a>(&mut self, text: &'a Text, lines: &mut Lines<'a>) -> Result<(), Error> {
        while let Some(line) = lines.next() {
            if line.bytes.trim_ascii().is_empty() {
                continue;
            }
            let (records, raw) = (self.records.len(), self.raw.len());
            let epochs = self.epochs.len();
            let result = self.epoch(&line, lines);
            let complete = result.is_ok() && (text.ends_with_line_break() || !lines.is_at_end());
            if complete {
                continue;
            }
            if let Err(error) = result {
                // What goes wrong before the last line is no cut.
                if !lines.is_at_end() || epochs == 0 {
                    return Err(error);
                }
            }
            self.epochs.truncate(epochs);
            self.records.truncate(records);
            self.raw.truncate(raw);
            self.warnings
                .push(line.warning("the file was cut off in this epoch, which is left out"));
        }
        if self.raw.is_empty() {
            return Err(
                text.error("expected observations of GPS satellites on L1 or L2, found none")
            );
        }
        Ok(())
    }

    /// Reads an epoch or event that begins with a line.
    fn epoch<'a>(&mut self, line: &Line<'a>, lines: &mut Lines<'a>) -> Result<(), Error> {
        let (columns, flag) = if self.header.version < 3 {
            (EPOCH_2, 28)
        } else if line.column(0) == b'>' {
            (EPOCH_3, 31)
        } else {
            return Err(line.expected("an epoch, which begins with >"));
        };
        let flag_byte = line.column(flag);
        let count = line.count("how many satellites or lines follow", flag + 1, flag + 4);
        match flag_byte {
            b'0' | b'1' | b' ' => {}
            b'2'..=b'5' => return self.event(flag_byte, count?, line, lines),
            b'6' => {}
            _ => return Err(line.expected("an epoch with a flag from 0 to 6")),
        }
        let count = count?;
        let names = if self.header.version < 3 { names(line, lines, count)? } else { Vec::new() };
        let slips = flag_byte == b'6';
        let time = if slips { None } else { Some(self.time(line, columns)?) };
        let late = self.epochs.last().is_none_or(|last| time.is_some_and(|time| last.time < time));
        let keep = !slips && late;
        self.backwards += usize::from(!slips && !late);
        let (first, raw) = (self.records.len(), self.raw.len());
        for i in 0..count {
            let record = lines.expect("a satellite's observations")?;
            let prn = match names.get(i) {
                Some(name) => satellite(*name),
                None => satellite(
                    record.bytes.get(..3).and_then(|name| name.try_into().ok()).unwrap_or_default(),
                ),
            };
            let prn = prn.ok_or_else(|| record.expected("a satellite's observations"))?;
            let start = self.raw.len();
            self.observations(prn, record, lines)?;
            let Some(prn) = prn else { continue };
            if self.records[first..].iter().any(|&(other, _)| other == prn) {
                self.doubled += 1;
                self.raw.truncate(start);
            } else {
                self.records.push((prn, self.raw.len()));
            }
        }
        if let (true, Some(time)) = (keep, time) {
            let end = self.records.len();
            self.epochs.push(RawEpoch { time, power_failure: flag_byte == b'1', end });
            let mut start = raw;
            for &(prn, end) in &self.records[first..] {
                self.seen.count(prn, &self.raw[start..end]);
                start = end;
            }
        } else {
            self.records.truncate(first);
            self.raw.truncate(raw);
        }
        Ok(())
    }

    fn time(&self, line: &Line<'_>, columns: [usize; 7]) -> Result<GpsTime, Error> {
        if self.header.version < 3 {
            line.short_time(columns, full_year)
        } else {
            line.time(columns)
        }
    }

    /// Skips an event, unless it brings another list of observations.
    fn event<'a>(
        &mut self,
        flag: u8,
        count: usize,
        line: &Line<'a>,
        lines: &mut Lines<'a>,
    ) -> Result<(), Error> {
        if flag == b'2' || flag == b'3' {
            self.warnings
                .push(line.warning("the antenna is moved or the marker changes from here on"));
        }
        let mut changed = self.header.clone();
        for _ in 0..count {
            let line = lines.expect("a line of an event")?;
            changed.observables(&line)?;
        }
        self.header = changed.complete();
        Ok(())
    }

    /// Reads what was observed of a satellite, or skips it without a number of it.
    fn observations<'a>(
        &mut self,
        prn: Option<u8>,
        first: Line<'a>,
        lines: &mut Lines<'a>,
    ) -> Result<(), Error> {
        let old = self.header.version < 3;
        let (offset, in_a_line) = if old { (0, 5) } else { (3, usize::MAX) };
        let mut line = first;
        for (i, observable) in self.header.observables.iter().enumerate() {
            let place = i % in_a_line;
            if i > 0 && place == 0 {
                line = lines.expect("a satellite's further observations")?;
            }
            let (Some(observable), Some(_)) = (observable, prn) else { continue };
            let column = offset + 16 * place;
            let value = line.optional_number("an observation", column, column + 14)?;
            let Some(value) = value.filter(|&value| value != 0.0) else { continue };
            let lock = line.column(column + 14);
            let lock_lost = lock.is_ascii_digit() && (lock - b'0') & 1 == 1;
            let value = value / observable.scale;
            self.raw.push(Raw { signal: observable.signal, value, lock_lost });
        }
        Ok(())
    }

    /// Chooses the signals and takes them out.
    fn finish(mut self, text: &Text) -> Observations {
        let signals = self.seen.choose();
        let mut epochs = Vec::with_capacity(self.epochs.len());
        let (mut record, mut start) = (0, 0);
        for epoch in &self.epochs {
            let mut satellites = Vec::with_capacity(epoch.end - record);
            for &(prn, end) in &self.records[record..epoch.end] {
                let chosen = signals.get(&prn).copied().unwrap_or_default();
                satellites.push(chosen.take(prn, &self.raw[start..end]));
                start = end;
            }
            record = epoch.end;
            let RawEpoch { time, power_failure, .. } = *epoch;
            epochs.push(Epoch { time, power_failure, satellites });
        }
        let mut warn = |count: usize, problem: &str| {
            if count > 0 {
                self.warnings.push(text.warning(format!("{count} {problem}")));
            }
        };
        warn(self.backwards, "epochs are not later than the one before and are left out");
        warn(self.doubled, "satellites are told of twice in an epoch; the first is taken");
        self.warnings.extend(Signals::warnings(&signals).into_iter().map(|it| text.warning(it)));
        let Header { marker, receiver, antenna, approximate_position, antenna_delta_hen, .. } =
            self.header;
        Observations {
            marker,
            receiver,
            antenna,
            approximate_position,
            antenna_delta_hen,
            epochs,
            signals,
            warnings: self.warnings,
        }
    }
}

/// The satellites of an epoch of RINEX 2: twelve in a line.
fn names<'a>(line: &Line<'a>, lines: &mut Lines<'a>, count: usize) -> Result<Vec<[u8; 3]>, Error> {
    let mut names = Vec::with_capacity(count.min(999));
    let mut line = *line;
    for i in 0..count {
        if i > 0 && i % 12 == 0 {
            line = lines.expect("further satellites of the epoch")?;
        }
        let column = 32 + 3 * (i % 12);
        let name = [0, 1, 2].map(|place| line.column(column + place));
        if satellite(name).is_none() {
            return Err(line.expected("the satellites of an epoch"));
        }
        names.push(name);
    }
    Ok(names)
}

/// A satellite's number if it is one of GPS, none if it is another; nothing if it is no satellite.
fn satellite(name: [u8; 3]) -> Option<Option<u8>> {
    match name {
        [b'G' | b' ', ..] => gps_satellite(&name).map(Some),
        [b'A'..=b'Z', b'0'..=b'9' | b' ', b'0'..=b'9'] => Some(None),
        _ => None,
    }
}
