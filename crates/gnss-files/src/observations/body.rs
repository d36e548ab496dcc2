//! The body of an observation file: its epochs.

use std::collections::BTreeSet;

use super::header::Header;
use super::names::{Named, names, satellite};
use super::order::in_order;
use super::record::{Epoch, Observations, Observed};
use super::signals::{Raw, Seen, Signals};
use crate::biases::Biases;
use crate::error::{Error, Warning};
use crate::streams::Stream;
use crate::system::{System, satellite_name};
use crate::text::{Line, Lines, Text};
use crate::time::{GpsTime, full_year};
use crate::unserved::Unserved;

/// The share of epochs, one in so many, that may be damaged.
const MOST_DAMAGED: usize = 100;

/// The epochs of a file with all their signals.
#[derive(Debug, Default)]
pub(super) struct Body {
    header: Header,
    /// The header with the antennas of later events, which are reported but not used.
    latest: Header,
    epochs: Vec<RawEpoch>,
    /// The records of all epochs one after the other: the satellite, and the end of its part of `raw`.
    records: Vec<(u8, usize)>,
    raw: Vec<Raw>,
    moved: bool,
    doubled: usize,
    unserved: Unserved,
    warnings: Vec<Warning>,
}

#[derive(Debug)]
struct RawEpoch {
    time: GpsTime,
    power_failure: bool,
    /// The end of the epoch's part of the records.
    end: usize,
}

/// Whether a line is the first one of a file.
fn is_header(line: &Line<'_>) -> bool {
    line.label() == b"RINEX VERSION / TYPE"
}

impl Body {
    pub(super) fn new(header: Header) -> Self {
        Self { latest: header.clone(), header, ..Self::default() }
    }

    /// Reads all epochs. A damaged one is left out where the next is recognised by its first letter, from RINEX 3 on.
    pub(super) fn read<'a>(&mut self, text: &'a Text, lines: &mut Lines<'a>) -> Result<(), Error> {
        self.warnings.extend(self.header.antenna_problem().map(|problem| text.warning(problem)));
        let (mut damaged, mut first_damage) = (0, None);
        while let Some(line) = lines.next() {
            if line.bytes.trim_ascii().is_empty() {
                continue;
            }
            let (records, raw, epochs) = (self.records.len(), self.raw.len(), self.epochs.len());
            let (doubled, below) = (self.doubled, lines.clone());
            let result = self.epoch(&line, lines);
            let complete = result.is_ok() && (text.ends_with_line_break() || !lines.is_at_end());
            if complete {
                continue;
            }
            self.doubled = doubled;
            self.epochs.truncate(epochs);
            self.records.truncate(records);
            self.raw.truncate(raw);
            // An error before the last line is no truncation.
            match result {
                Err(error) if !lines.is_at_end() || epochs == 0 => {
                    if self.header.version < 3 || epochs == 0 || is_header(&line) {
                        return Err(error);
                    }
                    damaged += 1;
                    first_damage = first_damage.or(Some(error));
                    *lines = below;
                    lines.skip_to_epoch();
                }
                _ => self
                    .warnings
                    .push(line.warning("the file was cut off in this epoch, which is left out")),
            }
        }
        if let Some(first) = first_damage {
            if damaged * MOST_DAMAGED > self.epochs.len() {
                return Err(first);
            }
            let (line, problem) = match first {
                Error::Line { line, problem, .. } => (Some(line), problem),
                other => (None, other.to_string()),
            };
            let problem =
                format!("damaged epochs, left out: {damaged}; the first is this: {problem}");
            self.warnings.push(Warning { line, ..text.warning(problem) });
        }
        if self.raw.is_empty() {
            return Err(
                text.error("expected observations of GPS, Galileo, GLONASS or BeiDou, found none")
            );
        }
        Ok(())
    }

    /// Adds the epochs of a stream.
    pub(super) fn take(&mut self, text: &Text, stream: Stream) -> Result<(), Error> {
        self.warnings.extend(stream.warnings);
        self.unserved = stream.observed;
        self.header.channels = stream.channels;
        for (time, satellites) in stream.epochs {
            let first = self.records.len();
            for (satellite, raw) in satellites {
                if self.records[first..].iter().any(|&(other, _)| other == satellite) {
                    self.doubled += 1;
                    continue;
                }
                self.raw.extend(raw);
                self.records.push((satellite, self.raw.len()));
            }
            self.epochs.push(RawEpoch { time, power_failure: false, end: self.records.len() });
        }
        if self.raw.is_empty() {
            return Err(
                text.error("expected observations of GPS, Galileo, GLONASS or BeiDou, found none")
            );
        }
        Ok(())
    }

    /// Reads the epoch or event that begins with `line`.
    fn epoch<'a>(&mut self, line: &Line<'a>, lines: &mut Lines<'a>) -> Result<(), Error> {
        if is_header(line) {
            return Err(line.error("expected an epoch, found the header of a second file: separate files that were joined"));
        }
        let old = self.header.version < 3;
        if !old && line.column(0) != b'>' {
            return Err(line.expected("an epoch, which begins with >"));
        }
        let place = if old { 28 } else { 31 };
        let flag = line.column(place);
        if !matches!(flag, b'0'..=b'6' | b' ') {
            return Err(line.expected("an epoch with a flag from 0 to 6"));
        }
        let count = line.count("how many satellites or lines follow", place + 1, place + 4)?;
        if matches!(flag, b'2'..=b'5') {
            return self.event(flag, count, line, lines);
        }
        let names = if old { names(line, lines, count)? } else { Vec::new() };
        // Cycle slips that the receiver repaired are written like observations.
        let time = if flag == b'6' { None } else { Some(self.time(line)?) };
        let (first, raw) = (self.records.len(), self.raw.len());
        for i in 0..count {
            let line = lines.expect("a satellite's observations")?;
            let name = names.get(i).copied().unwrap_or([0, 1, 2].map(|place| line.column(place)));
            let named =
                satellite(name, old).ok_or_else(|| line.expected("a satellite's observations"))?;
            let start = self.raw.len();
            self.observations(named, line, lines)?;
            let prn = match named {
                Named::Known(prn) => prn,
                Named::Other(name) => {
                    self.unserved.note_name(name);
                    continue;
                }
            };
            if self.records[first..].iter().any(|&(other, _)| other == prn) {
                self.doubled += 1;
                self.raw.truncate(start);
            } else {
                self.records.push((prn, self.raw.len()));
            }
        }
        if let Some(time) = time {
            let end = self.records.len();
            self.epochs.push(RawEpoch { time, power_failure: flag == b'1', end });
        } else {
            self.records.truncate(first);
            self.raw.truncate(raw);
        }
        Ok(())
    }

    fn time(&self, line: &Line<'_>) -> Result<GpsTime, Error> {
        if self.header.version < 3 {
            line.short_time([1, 3, 6, 9, 12, 15, 26], full_year)
        } else {
            line.time([2, 6, 9, 12, 15, 18, 29])
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
        if matches!(flag, b'2' | b'3') && !self.moved {
            self.moved = true;
            let problem = "the antenna is moved or the marker changes from here on";
            self.warnings.push(line.warning(problem));
        }
        let mut changed = self.header.clone();
        for _ in 0..count {
            let line = lines.expect("a line of an event")?;
            if let Some(problem) = self.latest.another_antenna(&line) {
                self.warnings.push(line.warning(problem));
            }
            changed.observables(&line)?;
        }
        self.header = changed.complete();
        Ok(())
    }

    /// Reads the observations of a satellite, or skips them if it has no number.
    fn observations<'a>(
        &mut self,
        named: Named,
        first: Line<'a>,
        lines: &mut Lines<'a>,
    ) -> Result<(), Error> {
        let old = self.header.version < 3;
        let (offset, in_a_line) = if old { (0, 5) } else { (3, usize::MAX) };
        let mut line = first;
        // RINEX 2 has one list for all systems.
        let system = named.system().unwrap_or(System::Gps);
        let observables = self.header.observables_of(system);
        for (i, observable) in observables.iter().enumerate() {
            let place = i % in_a_line;
            if i > 0 && place == 0 {
                line = lines.expect("a satellite's further observations")?;
            }
            let (Some(observable), Named::Known(_)) = (observable, named) else { continue };
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

    /// Chooses the signals and extracts their observations, with code biases subtracted.
    pub(super) fn finish(mut self, text: &Text, biases: &Biases) -> Observations {
        let times: Vec<_> = self.epochs.iter().map(|epoch| epoch.time).collect();
        let kept = in_order(&times);
        let mut seen = Seen::default();
        let (mut record, mut start) = (0, 0);
        for (epoch, is_kept) in self.epochs.iter().zip(&kept) {
            for &(prn, end) in &self.records[record..epoch.end] {
                if *is_kept {
                    seen.count(prn, &self.raw[start..end]);
                }
                start = end;
            }
            record = epoch.end;
        }
        let channels = &self.header.channels;
        let signals = seen.choose(channels);
        let names: Vec<_> = seen.without_channel(channels).map(satellite_name).collect();
        if !names.is_empty() {
            let problem = format!("tells no channel of {}: they are left out", names.join(" "));
            self.warnings.push(text.warning(problem));
        }
        let mut corrected = BTreeSet::new();
        let mut epochs = Vec::with_capacity(self.epochs.len());
        let (mut record, mut start) = (0, 0);
        for (epoch, is_kept) in self.epochs.iter().zip(kept) {
            let mut satellites = Vec::with_capacity(epoch.end - record);
            for &(prn, end) in &self.records[record..epoch.end] {
                let raw = &self.raw[start..end];
                start = end;
                let Some(chosen) = signals.get(&prn).copied().filter(|_| is_kept) else { continue };
                let mut observed = Observed::of(prn, &chosen, raw);
                if let Some(biases) = biases.of_codes(prn, chosen.carriers, chosen.code, epoch.time)
                {
                    observed.shorten(biases);
                    corrected.insert(prn);
                }
                satellites.push(observed);
            }
            record = epoch.end;
            let RawEpoch { time, power_failure, .. } = *epoch;
            if is_kept {
                epochs.push(Epoch { time, power_failure, satellites });
            }
        }
        let mut warn = |count: usize, problem: &str| {
            if count > 0 {
                self.warnings.push(text.warning(format!("{count} {problem}")));
            }
        };
        let out_of_order = times.len() - epochs.len();
        warn(out_of_order, "epochs stand out of the order of time and are left out");
        warn(self.doubled, "satellites are told of twice in an epoch; the first is taken");
        let others = signals.iter().filter(|(number, _)| !corrected.contains(number));
        self.warnings.extend(Signals::warnings(others).into_iter().map(|it| text.warning(it)));
        let Header { marker, receiver, antenna, approximate_position, antenna_delta_hen, .. } =
            self.header;
        Observations {
            marker,
            receiver,
            antenna,
            approximate_position,
            antenna_delta_hen: antenna_delta_hen.unwrap_or_default(),
            epochs,
            signals,
            unserved: self.unserved.sentence("satellites").map(|it| text.warning(it)),
            warnings: self.warnings,
        }
    }
}
