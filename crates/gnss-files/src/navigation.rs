//! Broadcast ephemerides: RINEX navigation files 2.x, 3.0x and 4.0x.

mod ephemeris;
mod record;
#[cfg(test)]
mod tests;

use std::path::Path;

#[cfg(any(feature = "rtcm", feature = "ubx"))]
pub(crate) use self::ephemeris::time_of_week;
pub use self::ephemeris::{Ephemeris, Message};
use self::record::{Layout, Record};
use crate::error::{Error, Warning};
use crate::fields::{blank_separated, decimal};
use crate::satellites::PerSatellite;
use crate::ssr::SsrCorrection;
use crate::streams::Stream;
use crate::text::{Line, Lines, Text};
use crate::unserved::Unserved;

/// The warning about a record that no satellite can have sent.
const NO_ORBIT: &str = "this record's orbit is no ellipse: it is left out";

/// Broadcast ephemerides of satellites, which are identified by number ([`Observed::prn`](crate::Observed::prn)).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Navigation {
    /// Ephemerides of each message separately, as two messages of a Galileo satellite may hold for the same instant.
    messages: [PerSatellite<Ephemeris>; Message::ALL.len()],
    /// Corrections of the ephemerides of GPS (LNAV) and Galileo (I/NAV) by a service, in the order of its stream.
    pub corrections: Vec<SsrCorrection>,
    /// The coefficients of Klobuchar's ionosphere model as GPS broadcasts them: α in s, s per semicircle and so on,
    /// then β.
    pub ionosphere: Option<[[f64; 4]; 2]>,
    /// The number of records passed over: other systems, other messages, and orbits that are no ellipse.
    pub skipped: usize,
    /// Warnings that count the satellites with ephemerides of systems that are not read; empty for RINEX 2, whose files
    /// have one system each.
    pub unserved: Vec<Warning>,
    /// Warnings about the files.
    pub warnings: Vec<Warning>,
}

impl Navigation {
    /// Reads files in any order, such as those of three days. Where two hold the same ephemeris, the file that begins
    /// later takes precedence.
    ///
    /// # Errors
    /// [`Error`]: the file, the line, what was expected there and what was found.
    pub fn read(paths: &[impl AsRef<Path>]) -> Result<Self, Error> {
        let texts: Result<Vec<_>, _> = paths.iter().map(Text::read).collect();
        Self::parse(&texts?)
    }

    /// Reads files in memory, like [`Self::read`].
    ///
    /// # Errors
    /// Those of [`Self::read`].
    pub fn parse(texts: &[Text]) -> Result<Self, Error> {
        let mut navigation = Self::default();
        let mut files = Vec::new();
        for text in texts {
            let mut file = Vec::new();
            let corrections = navigation.corrections.len();
            match Stream::of(text)? {
                Some(stream) => navigation.take(text, stream, &mut file),
                None => navigation.parse_file(text, &mut file)?,
            }
            if file.is_empty() && navigation.corrections.len() == corrections {
                let problem =
                    "expected ephemerides of satellites of GPS, Galileo or BeiDou, found none";
                return Err(text.error(problem));
            }
            files.push(file);
        }
        navigation.put(&files);
        if let Some(text) = texts.first().filter(|_| navigation.is_empty()) {
            let problem = "expected the ephemerides that the corrections refer to, found none";
            return Err(text.error(problem));
        }
        Ok(navigation)
    }

    pub(crate) fn of_stream(text: &Text, stream: Stream) -> Self {
        let (mut navigation, mut file) = (Self::default(), Vec::new());
        navigation.take(text, stream, &mut file);
        navigation.put(&[file]);
        navigation
    }

    /// Navigation data from the ephemerides of a stream, each with the number of its satellite, in any order.
    pub fn of(ephemerides: impl IntoIterator<Item = (u8, Ephemeris)>) -> Self {
        let mut navigation = Self::default();
        navigation.put(&[ephemerides.into_iter().collect()]);
        navigation
    }

    /// The ephemerides of a satellite in one message, ordered by reference time; empty for a satellite that the files
    /// do not know.
    pub fn satellite(&self, number: u8, message: Message) -> &[Ephemeris] {
        self.messages[message as usize].of(number)
    }

    /// Whether there are no ephemerides.
    pub fn is_empty(&self) -> bool {
        self.satellites().next().is_none()
    }

    /// The numbers of the satellites in the files, each once.
    pub fn satellites(&self) -> impl Iterator<Item = u8> {
        let is_known = |number: &u8| self.messages.iter().any(|of| !of.of(*number).is_empty());
        (0..=u8::MAX).filter(is_known)
    }

    fn put(&mut self, files: &[Vec<(u8, Ephemeris)>]) {
        for message in Message::ALL {
            let of_message = |file: &Vec<(u8, Ephemeris)>| {
                let mut satellites = PerSatellite::default();
                for (number, ephemeris) in file.iter().filter(|(_, it)| it.message == message) {
                    satellites.push(*number, *ephemeris);
                }
                satellites
            };
            let files = files.iter().map(of_message).collect();
            self.messages[message as usize] =
                PerSatellite::merge(files, |ephemeris| ephemeris.time, |_, _| ());
        }
    }

    fn take(&mut self, text: &Text, stream: Stream, found: &mut Vec<(u8, Ephemeris)>) {
        self.ionosphere = stream.ionosphere.or(self.ionosphere);
        self.skipped += stream.skipped;
        self.corrections.extend(stream.corrections);
        self.warnings.extend(stream.warnings);
        self.tell(text, &stream.unread);
        let (orbits, others): (Vec<_>, Vec<_>) =
            stream.ephemerides.into_iter().partition(|(_, ephemeris)| ephemeris.is_orbit());
        self.skipped += others.len();
        found.extend(orbits);
    }

    fn parse_file(&mut self, text: &Text, found: &mut Vec<(u8, Ephemeris)>) -> Result<(), Error> {
        let mut lines = text.lines();
        let layout = self.header(text, &mut lines)?;
        let mut unserved = Unserved::default();
        while let Some(line) = lines.next() {
            if line.bytes.trim_ascii().is_empty() {
                continue;
            }
            let read = match Record::of(line, layout, &mut lines) {
                Record::Ephemeris(number, message, numbers) => {
                    let ephemeris = Ephemeris::read(number, message, &numbers);
                    ephemeris.map(|ephemeris| {
                        if ephemeris.is_orbit() {
                            found.push((number, ephemeris));
                        } else {
                            self.skipped += 1;
                            self.warnings.push(line.warning(NO_ORBIT));
                        }
                    })
                }
                Record::Ionosphere(numbers) => {
                    numbers.ionosphere().map(|ionosphere| self.ionosphere = Some(ionosphere))
                }
                Record::Other => {
                    self.skipped += 1;
                    layout.sender(&line).into_iter().for_each(|name| unserved.note_name(name));
                    Ok(())
                }
            };
            match read {
                Err(_) if lines.is_at_end() && !text.ends_with_line_break() => {
                    let problem = "the file ends within this record, which is left out";
                    self.warnings.push(line.warning(problem));
                }
                read => read?,
            }
        }
        self.tell(text, &unserved);
        Ok(())
    }

    fn tell(&mut self, text: &Text, unserved: &Unserved) {
        self.unserved.extend(unserved.sentence("ephemerides").map(|it| text.warning(it)));
    }

    fn header(&mut self, text: &Text, lines: &mut Lines<'_>) -> Result<Layout, Error> {
        let first = lines.next().filter(|line| line.label() == b"RINEX VERSION / TYPE");
        let wrong = || text.wrong_kind("a navigation file (RINEX)");
        let first = first.ok_or_else(wrong)?;
        let version = first.finite("a version of RINEX", 0, 9)?;
        if !(2.0..5.0).contains(&version) {
            return Err(first.error(format!("expected RINEX 2, 3 or 4, found version {version}")));
        }
        let layout = Layout::of(version, first.column(20)).ok_or_else(wrong)?;
        let mut ionosphere = [None; 2];
        for line in lines {
            match line.label() {
                b"END OF HEADER" => {
                    if let [Some(alpha), Some(beta)] = ionosphere {
                        self.ionosphere = Some([alpha, beta]);
                    }
                    return Ok(layout);
                }
                b"ION ALPHA" => ionosphere[0] = four(&line, 2),
                b"ION BETA" => ionosphere[1] = four(&line, 2),
                b"IONOSPHERIC CORR" if line.bytes.starts_with(b"GPSA") => {
                    ionosphere[0] = four(&line, 5);
                }
                b"IONOSPHERIC CORR" if line.bytes.starts_with(b"GPSB") => {
                    ionosphere[1] = four(&line, 5);
                }
                _ => {}
            }
        }
        Err(text.error("expected the end of the header, found the end of the file"))
    }
}

/// Four numbers from a column of a header line on; `None` if they cannot be read, which costs only the single-frequency
/// ionosphere model.
fn four(line: &Line<'_>, from: usize) -> Option<[f64; 4]> {
    let mut numbers = blank_separated(line.columns(from, 60)).map(decimal);
    let mut next = || numbers.next().flatten();
    Some([next()?, next()?, next()?, next()?])
}
