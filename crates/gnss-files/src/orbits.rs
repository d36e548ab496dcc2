//! Satellite orbits: SP3-a, -b, -c and -d.

use std::path::Path;

use crate::antenna_model::AntennaModel;
use crate::error::{Error, Warning};
use crate::satellites::{Differing, PerSatellite};
use crate::system::satellite;
use crate::text::{Line, Text};
use crate::time::GpsTime;

/// The value that stands for an unknown clock, µs.
const NO_CLOCK: f64 = 999_999.0;

/// Tolerance within which two positions of a satellite at one instant are of the same solution, m.
const SAME_PLACE: f64 = 0.01;

/// The position and the clock of a satellite at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrbitSample {
    /// The instant.
    pub time: GpsTime,
    /// The centre of mass, m, in the file's Earth-fixed frame (ECEF; an ITRF or IGS frame).
    pub position: [f64; 3],
    /// The satellite's clock minus GPS time, s, without the relativistic effect of the orbit's eccentricity; `None` if
    /// the file does not give it.
    pub clock: Option<f64>,
    /// Whether the clock is predicted rather than measured.
    pub clock_predicted: bool,
    /// Whether the clock jumped between the preceding sample and this one.
    pub clock_event: bool,
    /// Whether the satellite was manoeuvred between the preceding sample and this one, so that interpolation across it
    /// is wrong.
    pub manoeuvre: bool,
}

/// Orbits of satellites, which are identified by number ([`Observed::prn`](crate::Observed::prn)).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Orbits {
    samples: PerSatellite<OrbitSample>,
    /// The edition of the satellite antennas with which the files were made, from the first file that tells it
    /// (`PCV:`).
    pub antenna_model: Option<AntennaModel>,
    /// Warnings about the files.
    pub warnings: Vec<Warning>,
}

impl Orbits {
    /// Reads files in any order, such as those of three days. Where two hold the same instant, the file that begins
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
        let mut orbits = Self::default();
        let files: Result<Vec<_>, _> =
            texts.iter().map(|text| parse_file(text, &mut orbits)).collect();
        let mut differing = Differing::default();
        orbits.samples = PerSatellite::merge(
            files?,
            |sample| sample.time,
            |earlier, later| {
                let apart = |axis: usize| (later.position[axis] - earlier.position[axis]).abs();
                if (0..3).any(|axis| apart(axis) > SAME_PLACE) {
                    differing.add(later.time);
                }
                later.clock = later.clock.or(earlier.clock);
                later.clock_event |= earlier.clock_event;
                later.manoeuvre |= earlier.manoeuvre;
            },
        );
        orbits.warnings.extend(differing.warning(texts, "positions"));
        Ok(orbits)
    }

    /// The samples of a satellite in chronological order, perhaps with gaps; empty for a satellite that the files do
    /// not know.
    pub fn satellite(&self, prn: u8) -> &[OrbitSample] {
        self.samples.of(prn)
    }

    /// The numbers of the satellites in the files.
    pub fn satellites(&self) -> impl Iterator<Item = u8> {
        self.samples.numbers()
    }
}

fn parse_file(text: &Text, orbits: &mut Orbits) -> Result<PerSatellite<OrbitSample>, Error> {
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
                if let Some(prn) = name.get(..3).and_then(satellite) {
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
            [b'/', b'*', comment @ ..] => {
                orbits.antenna_model = orbits.antenna_model.or_else(|| antenna_model(comment));
            }
            [b'E', b'P' | b'V', ..] | [b'V' | b'#' | b'+' | b'%' | b'/', ..] => {}
            _ if line.bytes.trim_ascii().is_empty() => {}
            _ => return Err(line.expected("a record of an SP3 file")),
        }
    }
    if samples.is_empty() {
        return Err(first.error(
            "expected orbits of satellites of GPS, Galileo, GLONASS or BeiDou, found none",
        ));
    }
    if !ended {
        orbits.warnings.push(text.warning("has no EOF at its end: it may have been cut off"));
    }
    if predicted > 0 {
        let problem = format!("holds {predicted} predicted positions, worse than computed ones");
        orbits.warnings.push(text.warning(problem));
    }
    Ok(samples)
}

/// The edition in a comment such as `PCV:IGS14_2108 OL/AL:FES2012`.
fn antenna_model(comment: &[u8]) -> Option<AntennaModel> {
    let told = comment.trim_ascii_start().strip_prefix(b"PCV:")?;
    AntennaModel::named(told.split(|&byte| byte == b' ').next()?)
}

/// Accepts the time systems of GPS, Galileo and QZSS, which agree to some nanoseconds.
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
    // Zeros stand for an unknown position.
    let known = position.iter().any(|&coordinate| coordinate != 0.0);
    Ok(known.then(|| OrbitSample {
        time,
        position,
        clock: clock.filter(|clock| clock.abs() < NO_CLOCK).map(|clock| clock / 1e6),
        clock_predicted: line.column(75) == b'P',
        clock_event: line.column(74) == b'E',
        manoeuvre: line.column(78) == b'M',
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{orbits, sentences, text};

    fn complaint(file: &str) -> String {
        Orbits::parse(&[text(file)]).expect_err(file).to_string()
    }

    #[test]
    fn positions_and_clocks_are_read() -> Result<(), Error> {
        let orbits = Orbits::parse(&[text(orbits())])?;
        assert_eq!(orbits.satellites().collect::<Vec<_>>(), [5]);
        let [first, second] = *orbits.satellite(5) else { panic!("two samples") };
        assert_eq!(first.position, [10_000_000.001, -20e6, 15_000_500.0]);
        assert_eq!((first.time, first.clock), (GpsTime::new(58_849, 0.0), Some(1e-4)));
        assert!(!first.clock_event && !first.manoeuvre);
        assert_eq!((second.time, second.clock), (GpsTime::new(58_849, 900.0), None));
        assert!(second.clock_event && second.clock_predicted && second.manoeuvre);
        let warning = "file: holds 1 predicted positions, worse than computed ones";
        assert_eq!(sentences(&orbits.warnings), [warning]);
        Ok(())
    }

    #[test]
    fn the_edition_of_the_antennas_is_read() -> Result<(), Error> {
        let of = |file: String| Ok::<_, Error>(Orbits::parse(&[text(file)])?.antenna_model);
        assert_eq!(of(orbits())?, None);
        let told = orbits().replace("/* BY HAND", "/* PCV:IGS14_2108 OL/AL:igs20");
        assert_eq!(of(told)?, Some(AntennaModel::Igs14));
        assert_eq!(of(orbits().replace("/* BY HAND", "/* PCV: OL/AL:igs20"))?, None);
        Ok(())
    }

    #[test]
    fn days_are_put_together_in_any_order() -> Result<(), Error> {
        let earlier =
            text(orbits().replace("EP  MP", "").replace("PG05  10001.0", "PG05  10009.0"));
        let later = orbits().replace("*  2020  1  1  0 15", "*  2020  1  1  0 30");
        let later = text(later.replace("*  2020  1  1  0  0", "*  2020  1  1  0 15"));
        let one = Orbits::parse(&[earlier.clone(), later.clone()])?;
        assert_eq!(one, Orbits::parse(&[later, earlier])?);
        let times: Vec<_> = one.satellite(5).iter().map(|sample| sample.time.second()).collect();
        assert_eq!(times, [0.0, 900.0, 1800.0]);
        assert_eq!(one.satellite(5)[1].position[0], 10_000_000.001);
        Ok(())
    }

    #[test]
    fn other_positions_at_the_same_times_are_told() -> Result<(), Error> {
        let three = orbits().replace(
            "EOF",
            "*  2020  1  1  0 30  0.00000000\nPG05  10002.000000 -20001.000000  15001.500000 999999.999999\nEOF",
        );
        let told = |other: String| -> Result<usize, Error> {
            Ok(Orbits::parse(&[text(&three), text(other)])?.warnings.len() - 2)
        };
        assert_eq!(told(three.clone())?, 0, "the same");
        assert_eq!(told(three.replace("PG05  10000", "PG05  10009"))?, 0, "where days meet");
        let other = three.replace("PG05  1000", "PG05  1100");
        assert_eq!(told(other.clone())?, 1);
        let warning = Orbits::parse(&[text(three), text(other)])?.warnings.pop();
        let sentence = warning.expect("one more").problem;
        assert!(sentence.contains("differ in positions at 3 times"), "{sentence}");
        Ok(())
    }

    #[test]
    fn satellites_without_letter_are_of_gps() -> Result<(), Error> {
        let file =
            orbits().replace("#c", "#a").replace("PG05", "P  5").replace("GPS ccc", "ccc ccc");
        assert_eq!(Orbits::parse(&[text(file)])?.satellite(5).len(), 2);
        let blank = orbits().replace("cc GPS", "cc    ");
        assert_eq!(Orbits::parse(&[text(blank)])?.satellite(5).len(), 2);
        Ok(())
    }

    #[test]
    fn what_cannot_be_used_is_refused() {
        let file = orbits().replace("cc GPS", "cc UTC");
        assert_eq!(
            complaint(&file),
            "file, line 5: expected times of GPS, found the time system \"UTC\""
        );
        let file = orbits().replace("-20000.000000", "-20000.00000x");
        assert!(complaint(&file).starts_with("file, line 11: expected a position in km"));
        assert!(
            complaint(&orbits().replace("PG05", "PJ05")).contains("GLONASS or BeiDou, found none")
        );
        assert!(complaint("walk\n").contains("expected orbits (SP3), found \"walk\""));
    }

    #[test]
    fn lines_cut_within_a_number_are_refused() {
        for column in [24, 40, 50, 59] {
            let cut = |line: &str| line[..line.len().min(column)].to_owned() + "\n";
            let found = complaint(&orbits().lines().map(cut).collect::<String>());
            let expected = format!("found the line's end in column {column}: cut off?");
            assert!(found.contains(&expected), "{column}: {found}");
        }
    }

    #[test]
    fn a_file_cut_off_is_told() -> Result<(), Error> {
        let file = orbits();
        let cut = Orbits::parse(&[text(&file[..file.len() - 60])])?;
        assert_eq!(cut.satellite(5).len(), 1);
        assert!(sentences(&cut.warnings)[0].contains("no EOF"), "{:?}", cut.warnings);
        Ok(())
    }
}
