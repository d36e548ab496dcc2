//! Code and phase biases of satellites: Bias-SINEX 1.00, absolute (OSB) and, for codes, differential (DSB).

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::Error;
use crate::fields::{decimal, integer};
use crate::observations::{Carriers, Signal};
use crate::system::satellite;
use crate::text::{Line, Text};
use crate::time::GpsTime;

/// Speed of light, m/s.
pub(crate) const SPEED_OF_LIGHT: f64 = 299_792_458.0;

/// The bias of one code or phase of a satellite, or of one code minus another.
#[derive(Debug, Clone, PartialEq)]
struct Bias {
    signal: Signal,
    /// The code that is subtracted, if the bias is differential.
    less: Option<Signal>,
    /// The first and the last instant of validity; an open end is `None`.
    span: [Option<GpsTime>; 2],
    metres: f64,
}

/// Code and phase biases of satellites, by satellite number.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Biases(BTreeMap<u8, Vec<Bias>>);

impl Biases {
    /// Reads files. Where two hold the same bias, the later file takes precedence.
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
        let mut biases = Self::default();
        for text in texts {
            biases.add(text)?;
        }
        Ok(biases)
    }

    fn add(&mut self, text: &Text) -> Result<(), Error> {
        let mut lines = text.lines();
        let first = lines.next().filter(|line| line.bytes.starts_with(b"%=BIA"));
        first.ok_or_else(|| text.wrong_kind("biases (Bias-SINEX)"))?;
        let mut found = false;
        let mut inside = false;
        for line in lines {
            match line.bytes {
                [b'+', rest @ ..] => inside = rest.starts_with(b"BIAS/SOLUTION"),
                [b'-' | b'%', ..] => inside = false,
                [b' ', ..] if inside => {
                    if let Some((satellite, bias)) = bias(&line)? {
                        found = true;
                        self.0.entry(satellite).or_default().push(bias);
                    }
                }
                _ => {}
            }
        }
        if !found {
            return Err(text.error("expected biases of satellites' codes, found none"));
        }
        Ok(())
    }

    /// The biases by which the two codes of a satellite are too long at a time, m, relative to the codes to which
    /// satellite clocks refer; `None` for a pair of which either is unknown.
    pub fn of_codes(
        &self,
        satellite: u8,
        carriers: Carriers,
        codes: [Option<Signal>; 2],
        time: GpsTime,
    ) -> Option<[f64; 2]> {
        let [first, second] = codes;
        let (first, second) = (first?, second?);
        let biases = self.valid(satellite, time)?;
        let both = |of: &dyn Fn(Signal) -> Option<f64>| Some([of(first)?, of(second)?]);
        let differential = |code: Signal| {
            let reference = code.reference(carriers)?;
            if reference == code {
                return Some(0.0);
            }
            biases.iter().rev().find_map(|it| match (it.signal, it.less?) {
                pair if pair == (code, reference) => Some(it.metres),
                pair if pair == (reference, code) => Some(-it.metres),
                _ => None,
            })
        };
        both(&|code| absolute(&biases, code)).or_else(|| both(&differential))
    }

    /// The biases by which the two phases of a satellite are too long at a time, m; `None` for a pair of which either
    /// is unknown.
    ///
    /// Without them each phase is a whole number of cycles apart from the receiver's own bias.
    pub fn of_phases(
        &self,
        satellite: u8,
        phases: [Option<Signal>; 2],
        time: GpsTime,
    ) -> Option<[f64; 2]> {
        let biases = self.valid(satellite, time)?;
        let [first, second] = phases;
        Some([absolute(&biases, first?)?, absolute(&biases, second?)?])
    }

    /// Whether no bias is known.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether any phase bias is known.
    pub fn have_phases(&self) -> bool {
        self.0.values().flatten().any(|bias| bias.signal.phase)
    }

    fn valid(&self, satellite: u8, time: GpsTime) -> Option<Vec<&Bias>> {
        Some(self.0.get(&satellite)?.iter().filter(|it| it.is_valid(time)).collect())
    }
}

fn absolute(biases: &[&Bias], signal: Signal) -> Option<f64> {
    let mut all = biases.iter().rev();
    Some(all.find(|it| it.less.is_none() && it.signal == signal)?.metres)
}

impl Bias {
    fn is_valid(&self, time: GpsTime) -> bool {
        let [from, until] = self.span;
        from.is_none_or(|from| from <= time) && until.is_none_or(|until| time <= until)
    }
}

/// The satellite and the bias of a line; `None` for a receiver's bias, for one phase minus another, and for a phase
/// bias in units other than ns.
fn bias(line: &Line<'_>) -> Result<Option<(u8, Bias)>, Error> {
    let kind = line.columns(1, 5);
    if !matches!(kind, b"OSB" | b"DSB") || !line.columns(15, 24).is_empty() {
        return Ok(None);
    }
    let name = line.columns(11, 14);
    let system = line.column(11);
    let other = |from, to| Signal::new(system, line.columns(from, to));
    let (Some(satellite), Some(signal)) = (satellite(name), other(25, 29)) else { return Ok(None) };
    if signal.phase && (kind == b"DSB" || line.columns(65, 69) != b"ns") {
        return Ok(None);
    }
    let less = match kind {
        b"DSB" => match other(30, 34).filter(|it| !it.phase) {
            Some(less) => Some(less),
            None => return Ok(None),
        },
        _ => None,
    };
    if line.columns(65, 69) != b"ns" {
        return Err(line.error("expected the bias of a code in ns"));
    }
    let value = decimal(line.columns(70, 91)).ok_or_else(|| line.expected("a bias"))?;
    let span = [instant(line, 35)?, instant(line, 50)?];
    Ok(Some((satellite, Bias { signal, less, span, metres: value * 1e-9 * SPEED_OF_LIGHT })))
}

/// The instant `year:day of year:second` that begins in a column; `None` if it is open, which zeros stand for.
fn instant(line: &Line<'_>, from: usize) -> Result<Option<GpsTime>, Error> {
    let parts = [(0, 4), (5, 8), (9, 14)].map(|(a, b)| integer(line.columns(from + a, from + b)));
    let [Some(year), Some(day), Some(second)] = parts else {
        return Err(line.expected("an instant as year:day:second"));
    };
    if [year, day, second] == [0; 3] {
        return Ok(None);
    }
    let begin = GpsTime::from_calendar([year, 1, 1, 0, 0], 0.0)
        .filter(|_| (1..=366).contains(&day) && (0..=86_400).contains(&second))
        .ok_or_else(|| line.expected("an instant as year:day:second"))?;
    Ok(Some(GpsTime::new(begin.day() + day - 1, f64::from(second))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{biases, text};

    fn signal(system: u8, code: &[u8]) -> Option<Signal> {
        Signal::new(system, code)
    }

    #[test]
    fn absolute_and_differential_biases() -> Result<(), Error> {
        let biases = Biases::parse(&[text(biases())])?;
        let at = |day, second| GpsTime::new(59_424 + day, second);
        let of = |satellite, codes: [&[u8]; 2], time| {
            biases.of_codes(satellite, Carriers::L1L2, codes.map(|code| signal(b'G', code)), time)
        };
        let metres = |ns: f64| ns * 1e-9 * SPEED_OF_LIGHT;
        let both = |found: Option<[f64; 2]>, [first, second]: [f64; 2]| {
            let [a, b] = found.expect("both are known");
            assert!((a - metres(first)).abs() < 1e-9 && (b - metres(second)).abs() < 1e-9);
        };
        both(of(1, [b"C1C", b"C2L"], at(0, 10.0)), [9.7876, 16.3019]);
        assert_eq!(of(1, [b"C1C", b"C2X"], at(0, 10.0)), None, "one of them is not known");
        assert_eq!(of(1, [b"C1C", b"C2L"], at(2, 0.0)), None, "another day");
        // Satellite clocks refer to C1W and C2W; biases given in the opposite direction count, too.
        both(of(2, [b"C1C", b"C2L"], at(900, 0.0)), [-1.5, 0.5]);
        both(of(2, [b"C1C", b"C2W"], at(0, 0.0)), [-1.5, 0.0]);
        let codes = [signal(b'E', b"C1C"), signal(b'E', b"C7Q")];
        assert_eq!(biases.of_codes(111, Carriers::E1E5b, codes, at(0, 0.0)), None);
        Ok(())
    }

    #[test]
    fn absolute_biases_of_phases() -> Result<(), Error> {
        let phase = " OSB  G063 G01           L2W       2021:210:00000 2021:210:86400 ns                 -1.9410 .146400E+00\n";
        let file = biases().replace(" cyc ", " ns  ").replace("-BIAS", &format!("{phase}-BIAS"));
        let read = Biases::parse(&[text(&file)])?;
        let phases = [signal(b'G', b"L1C"), signal(b'G', b"L2W")];
        let of = |phases, day| read.of_phases(1, phases, GpsTime::new(59_424 + day, 0.0));
        let [first, second] = of(phases, 0).expect("both are known");
        let metres = |ns: f64| ns * 1e-9 * SPEED_OF_LIGHT;
        assert!((first - metres(16.3019)).abs() < 1e-9 && (second - metres(-1.941)).abs() < 1e-9);
        assert_eq!(of(phases, 2), None, "another day");
        assert_eq!(of([phases[0], signal(b'G', b"L2L")], 0), None);
        // Biases in cycles are left out, as the file does not tell the length of a cycle.
        assert!(read.have_phases() && !Biases::parse(&[text(biases())])?.have_phases());
        Ok(())
    }

    #[test]
    fn damage_is_located() {
        let complaint = |file: &str| Biases::parse(&[text(file)]).expect_err(file).to_string();
        assert!(complaint("walk\n").contains("expected biases (Bias-SINEX), found \"walk\""));
        let file = biases();
        assert!(Biases::parse(&[text(format!("\u{feff}{file}"))]).is_ok(), "a byte order mark");
        assert!(complaint(&file.replace("9.7876", "9.7x76")).contains("line 4: expected a bias"));
        assert!(complaint(&file.replace(" ns ", " cm ")).contains("in ns"));
        assert!(complaint(&file.replace("2021:210", "2021:x10")).contains("an instant"));
        assert!(complaint("%=BIA 1.00\n").contains("found none"));
    }
}
