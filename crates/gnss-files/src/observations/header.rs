//! The header of an observation file.

use std::collections::BTreeMap;

use super::signals::{CHANNELS, Signal};
use crate::error::Error;
use crate::fields::{blank_separated, decimal, integer};
use crate::system::{System, satellite};
use crate::text::{Line, Lines, Text};

/// Upper limit on the height of an antenna's reference point above its marker, m: no tripod, mast or pillar raises it
/// farther.
const HIGHEST: f64 = 30.0;
/// Upper limit on the horizontal distance of an antenna's reference point from its marker, m, in each direction.
const FARTHEST: f64 = 5.0;
/// Upper limit on the horizontal distance, m, of an antenna that stands on its marker (zero height).
const ASIDE: f64 = 0.05;

/// An observation column that is used.
#[derive(Debug, Clone, Copy)]
pub(super) struct Observable {
    pub(super) signal: Signal,
    /// The factor by which the values in the file are multiplied.
    pub(super) scale: f64,
}

/// The parts of the header that are used.
#[derive(Debug, Clone, Default)]
pub(super) struct Header {
    /// The major version of RINEX.
    pub(super) version: i32,
    pub(super) marker: String,
    pub(super) receiver: String,
    pub(super) antenna: String,
    pub(super) approximate_position: Option<[f64; 3]>,
    /// The antenna's height, east and north offset from its marker, m, if given.
    pub(super) antenna_delta_hen: Option<[f64; 3]>,
    /// Whether the antenna stands beside the reference point of a vehicle, by the vehicle's axes.
    is_off_vehicle: bool,
    /// The observables, in the order of [`System::ALL`].
    lists: [List; System::ALL.len()],
    /// The frequency channels of GLONASS satellites, by satellite number.
    pub(super) channels: BTreeMap<u8, i8>,
    /// The satellite system of the list that the next line continues.
    system: u8,
}

/// The observables of a satellite system.
#[derive(Debug, Clone, Default)]
struct List {
    /// The observables by column; unused columns are `None`.
    observables: Vec<Option<Observable>>,
    /// The observation codes read so far, of the `announced` number.
    codes: Vec<Vec<u8>>,
    announced: usize,
    scales: Vec<(Vec<u8>, f64)>,
}

impl Header {
    pub(super) fn parse<'a>(text: &'a Text, lines: &mut Lines<'a>) -> Result<Self, Error> {
        let first = lines
            .next()
            .filter(|line| line.label() == b"RINEX VERSION / TYPE" && line.column(20) == b'O');
        let first = first.ok_or_else(|| text.wrong_kind("observations (RINEX)"))?;
        let version = first.finite("a version of RINEX", 0, 9)?;
        if !(2.0..5.0).contains(&version) {
            return Err(first.error(format!("expected RINEX 2, 3 or 4, found version {version}")));
        }
        let mut header = Self { version: version as i32, ..Self::default() };
        for line in lines.by_ref() {
            if line.label() == b"END OF HEADER" {
                let header = header.complete();
                if header
                    .lists
                    .iter()
                    .all(|list| list.observables.iter().flatten().next().is_none())
                {
                    let problem = "expected observations of GPS, Galileo, GLONASS or BeiDou in the header, found none";
                    return Err(text.error(problem));
                }
                return Ok(header);
            }
            header.line(&line)?;
        }
        Err(text.error("expected the end of the header, found the end of the file"))
    }

    fn line(&mut self, line: &Line<'_>) -> Result<(), Error> {
        match line.label() {
            b"MARKER NAME" => self.marker = line.text(0, 60),
            b"REC # / TYPE / VERS" => self.receiver = line.text(20, 40),
            b"ANT # / TYPE" => self.antenna = line.text(20, 40),
            b"APPROX POSITION XYZ" => {
                let position = three(line)?;
                // Zeros stand for an unknown position.
                self.approximate_position =
                    Some(position).filter(|position| position.iter().any(|&x| x != 0.0));
            }
            b"ANTENNA: DELTA H/E/N" => self.antenna_delta_hen = Some(three(line)?),
            b"ANTENNA: DELTA X/Y/Z" => {
                self.is_off_vehicle = three(line)?.iter().any(|&axis| axis != 0.0);
                self.antenna_delta_hen.get_or_insert_default();
            }
            b"TIME OF FIRST OBS" => time_system(line)?,
            b"GLONASS SLOT / FRQ #" => self.channels(line),
            _ => self.observables(line)?,
        }
        Ok(())
    }

    /// A problem with the antenna's offset from its marker, if there is one.
    pub(super) fn antenna_problem(&self) -> Option<String> {
        if self.is_off_vehicle {
            return Some("the antenna stands beside the vehicle's reference point (DELTA X/Y/Z), by the vehicle's own axes: the position is the antenna's".to_owned());
        }
        let Some([height, east, north]) = self.antenna_delta_hen else {
            return Some("no height of the antenna is told, so the position is not the marker's but the antenna's".to_owned());
        };
        let absurd = height.abs() > HIGHEST || east.abs() > FARTHEST || north.abs() > FARTHEST;
        let misplaced = height == 0.0 && east.abs().max(north.abs()) > ASIDE;
        (absurd || misplaced).then(|| {
            format!(
                "the antenna is told to be {height} m above its marker, {east} m east and {north} m north of it: look at their order"
            )
        })
    }

    /// Takes note of another antenna, or of another antenna offset, in a line of an event, and returns a warning about
    /// it.
    pub(super) fn another_antenna(&mut self, line: &Line<'_>) -> Option<String> {
        match line.label() {
            b"ANTENNA: DELTA H/E/N" => {
                let now = three(line).ok()?;
                let before = self.antenna_delta_hen.replace(now)?;
                let words = |[height, east, north]: [f64; 3]| {
                    format!("{height} m above its marker, {east} m east and {north} m north of it")
                };
                (now != before).then(|| {
                    format!(
                        "from here on the antenna is {}, before {}: not taken, cut the file here",
                        words(now),
                        words(before)
                    )
                })
            }
            b"ANT # / TYPE" => {
                let antenna = line.text(20, 40);
                let before = core::mem::replace(&mut self.antenna, antenna.clone());
                let is_another =
                    ![&antenna, &before].contains(&&String::new()) && antenna != before;
                is_another.then(|| {
                    format!("from here on the antenna is another, {antenna}, before {before}: not taken, cut the file here")
                })
            }
            _ => None,
        }
    }

    /// Reads up to eight GLONASS satellites with their channels; skips those whose number or channel cannot be read.
    fn channels(&mut self, line: &Line<'_>) {
        for field in (0..8).map(|place| 4 + 7 * place) {
            let number = satellite(line.columns(field, field + 3));
            let channel = integer(line.columns(field + 4, field + 6));
            let channel = channel.and_then(|channel| i8::try_from(channel).ok());
            let channel = channel.filter(|channel| CHANNELS.contains(channel));
            if let (Some(number), Some(channel)) = (number, channel) {
                self.channels.insert(number, channel);
            }
        }
    }

    /// Reads a line if it belongs to a list of observables or of scale factors; ignores any other.
    pub(super) fn observables(&mut self, line: &Line<'_>) -> Result<(), Error> {
        match line.label() {
            b"# / TYPES OF OBSERV" if self.version < 3 => {
                if !line.columns(0, 6).is_empty() {
                    self.start(b'G', line.count("how many observables there are", 0, 6)?);
                }
                self.extend(line, 6);
            }
            b"SYS / # / OBS TYPES" if self.version >= 3 => {
                if line.column(0) != b' ' {
                    let count = line.count("how many observables there are", 3, 6)?;
                    self.start(line.column(0), count);
                }
                self.extend(line, 6);
            }
            b"SYS / SCALE FACTOR" if self.version >= 3 => {
                let Some(list) = self.list(line.column(0)) else { return Ok(()) };
                let scale = line.finite("a scale factor", 2, 6)?;
                if scale <= 0.0 {
                    return Err(line.expected("a scale factor"));
                }
                let codes: Vec<_> =
                    blank_separated(line.columns(10, 60)).map(<[u8]>::to_vec).collect();
                if codes.is_empty() {
                    list.scales = vec![(Vec::new(), scale)];
                }
                list.scales.extend(codes.into_iter().map(|code| (code, scale)));
            }
            _ => {}
        }
        Ok(())
    }

    fn start(&mut self, system: u8, announced: usize) {
        self.system = system;
        if let Some(list) = self.list(system) {
            list.announced = announced;
            list.codes.clear();
        }
    }

    fn extend(&mut self, line: &Line<'_>, from: usize) {
        if let Some(list) = self.list(self.system) {
            let codes = blank_separated(line.columns(from, 60)).map(<[u8]>::to_vec);
            list.codes.extend(codes);
            list.codes.truncate(list.announced);
        }
    }

    fn list(&mut self, system: u8) -> Option<&mut List> {
        let system = System::of_letter(system)?;
        self.lists.get_mut(system as usize)
    }

    /// The observables of a system's satellites by column.
    pub(super) fn observables_of(&self, system: System) -> &[Option<Observable>] {
        &self.lists[system as usize].observables
    }

    /// Resolves the lists into the observables by column.
    pub(super) fn complete(mut self) -> Self {
        for (system, list) in System::ALL.into_iter().zip(&mut self.lists) {
            list.complete(system.letter());
        }
        self
    }
}

impl List {
    fn complete(&mut self, system: u8) {
        let scale = |code: &Vec<u8>| {
            let fits = |(of, _): &&(Vec<u8>, f64)| of.is_empty() || of == code;
            self.scales.iter().rev().find(fits).map_or(1.0, |&(_, scale)| scale)
        };
        let observable = |code: &Vec<u8>| {
            Some(Observable { signal: Signal::new(system, code)?, scale: scale(code) })
        };
        self.observables = self.codes.iter().map(observable).collect();
        // A list shorter than announced still has its columns.
        let announced = self.announced.min(999);
        if self.observables.len() < announced {
            self.observables.resize(announced, None);
        }
    }
}

fn three(line: &Line<'_>) -> Result<[f64; 3], Error> {
    let mut fields = blank_separated(line.columns(0, 42)).map(decimal);
    let complaint = || line.expected("three numbers");
    let mut next = || fields.next().flatten().ok_or_else(complaint);
    Ok([next()?, next()?, next()?])
}

/// Accepts the time systems of GPS, Galileo, QZSS and IRNSS, which agree to some nanoseconds.
fn time_system(line: &Line<'_>) -> Result<(), Error> {
    // Columns 48 to 51, or one beside, as some programs write it.
    match line.columns(43, 60) {
        b"" | b"GPS" | b"GAL" | b"QZS" | b"IRN" => Ok(()),
        other => {
            let found = String::from_utf8_lossy(other);
            Err(line.error(format!("expected times of GPS, found the time system {found:?}")))
        }
    }
}
