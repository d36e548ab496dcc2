//! One walk, written in many ways that a person reads at a glance: each is read right, or refused with the cause.

use std::fmt::Write as _;

use kestirim_import::inertial::{self, Inertial, Sample};
use kestirim_import::{Error, Options};

use crate::{plain, recordings, walk};

/// A way to write a log.
#[derive(Debug, Clone)]
struct Way {
    header: Header,
    separator: &'static str,
    decimal_comma: bool,
    /// The number of log units in 1 m/s², 1 rad/s and 1 s, and their symbols.
    acceleration: (f64, &'static str),
    rate: (f64, &'static str),
    time: (f64, &'static str),
    line_break: &'static str,
    harm: Harm,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Header {
    /// The header `t,ax,…`.
    Plain,
    /// Other names without units.
    Named,
    /// Names with units in brackets.
    Brackets,
    /// Names with units as a suffix.
    Behind,
    /// A line of units below the names.
    Line,
    /// A comment.
    Comment,
    None,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Harm {
    None,
    Cut,
    Torn,
    Doubled,
    Foreign,
    NotANumber,
    Back,
    Forth,
    Preamble,
    Quoted,
    Extra,
    Mark,
    Utf16,
}

const PLAIN: Way = Way {
    header: Header::Plain,
    separator: ",",
    decimal_comma: false,
    acceleration: (1.0, "m/s^2"),
    rate: (1.0, "rad/s"),
    time: (1.0, "s"),
    line_break: "\n",
    harm: Harm::None,
};

const G: f64 = 9.806_65;
const DEGREE: f64 = 180.0 / std::f64::consts::PI;

impl Way {
    /// The log, and the rows that it lacks.
    fn write(&self, rows: &[[f64; 7]]) -> (Vec<u8>, Vec<usize>) {
        let mut text = String::new();
        if self.harm == Harm::Preamble {
            text += &"Recorder: myLogger 1.2\nDate: 2024-05-01\n\n".replace('\n', self.line_break);
        }
        for line in self.header() {
            text += &line;
            text += self.line_break;
        }
        let mut left_out = Vec::new();
        let scales = [
            self.time,
            self.acceleration,
            self.acceleration,
            self.acceleration,
            self.rate,
            self.rate,
            self.rate,
        ];
        for (i, row) in rows.iter().enumerate() {
            let fields: Vec<_> = row
                .iter()
                .zip(scales)
                .map(|(value, (scale, _))| {
                    let mut field = format!("{:.9}", value * scale);
                    if self.acceleration.0 > 200.0 {
                        field = format!("{:.3}", value * scale);
                    }
                    if self.decimal_comma {
                        field = field.replace('.', ",");
                    }
                    if self.harm == Harm::Quoted {
                        field = format!("\"{field}\"");
                    }
                    field
                })
                .collect();
            let mut line = fields.join(self.separator);
            if self.harm == Harm::Extra {
                let _ = write!(line, "{}{}{}ok", self.separator, i, self.separator);
            }
            let is_hurt = i == rows.len() / 2 || i == rows.len() / 3;
            match self.harm {
                Harm::Torn if is_hurt => {
                    line.truncate(line.len() / 2);
                    left_out.push(i);
                }
                Harm::Doubled if is_hurt => line = format!("{line}{}{line}", self.line_break),
                Harm::Foreign if is_hurt => {
                    line = format!("Guru Meditation: core panic{}{line}", self.line_break);
                }
                Harm::NotANumber if is_hurt => {
                    line = line.replacen(&fields[4], "nan", 1);
                    left_out.push(i);
                }
                Harm::Back if is_hurt => {
                    line = line.replacen(
                        &fields[0],
                        &fields[0].replace(['4', '5', '6', '7', '8', '9'], "0"),
                        1,
                    );
                    if line != fields.join(self.separator) {
                        left_out.push(i);
                    }
                }
                Harm::Forth if is_hurt => {
                    line = format!("9{line}");
                    left_out.push(i);
                }
                Harm::Cut if i + 1 == rows.len() => {
                    line.truncate(line.len() / 2);
                    left_out.push(i);
                    text += &line;
                    break;
                }
                _ => {}
            }
            text += &line;
            text += self.line_break;
        }
        let bytes = match self.harm {
            Harm::Mark => format!("\u{feff}{text}").into_bytes(),
            Harm::Utf16 => {
                format!("\u{feff}{text}").encode_utf16().flat_map(u16::to_le_bytes).collect()
            }
            _ => text.into_bytes(),
        };
        (bytes, left_out)
    }

    fn header(&self) -> Vec<String> {
        let plain = ["t", "ax", "ay", "az", "gx", "gy", "gz"];
        let named = ["Timestamp", "AccX", "AccY", "AccZ", "GyrX", "GyrY", "GyrZ"];
        let units = [
            self.time.1,
            self.acceleration.1,
            self.acceleration.1,
            self.acceleration.1,
            self.rate.1,
            self.rate.1,
            self.rate.1,
        ];
        let extra = if self.harm == Harm::Extra {
            format!("{}count{}note", self.separator, self.separator)
        } else {
            String::new()
        };
        let join = |names: Vec<String>| {
            let names = names
                .into_iter()
                .map(|name| if self.harm == Harm::Quoted { format!("\"{name}\"") } else { name });
            names.collect::<Vec<_>>().join(self.separator) + &extra
        };
        let owned = |names: [&str; 7]| names.map(str::to_owned).to_vec();
        let both = |form: fn(&str, &str) -> String| {
            (0..7).map(|i| form(named[i], units[i])).collect::<Vec<_>>()
        };
        match self.header {
            Header::Plain => vec![join(owned(plain))],
            Header::Named => vec![join(owned(named))],
            Header::Brackets => vec![join(both(|name, unit| format!("{name}[{unit}]")))],
            Header::Behind => {
                vec![join(both(|name, unit| format!("{name}_{}", unit.replace(['/', '^'], ""))))]
            }
            Header::Line => vec![join(owned(named)), join(owned(units))],
            Header::Comment => {
                vec!["# made by hand".to_owned(), format!("# {}", join(owned(named)))]
            }
            Header::None => vec![],
        }
    }
}

fn ways() -> Vec<Way> {
    let mut ways = Vec::new();
    let dialects = [
        (",", false),
        (";", false),
        (";", true),
        ("\t", false),
        ("\t", true),
        (" ", false),
        ("  ", true),
        (", ", false),
    ];
    let units = [
        ((1.0, "m/s^2"), (1.0, "rad/s"), (1.0, "s")),
        ((1.0, "m/s²"), (DEGREE, "°/s"), (1e3, "ms")),
        ((1.0 / G, "g"), (DEGREE, "deg/s"), (1e3, "ms")),
        ((1e3 / G, "mg"), (DEGREE * 1e3, "mdps"), (1e6, "us")),
        ((1.0 / G, "g"), (DEGREE, "dps"), (1e9, "ns")),
        ((1.0 / G, "g"), (1.0, "rad/s"), (1.0, "s")),
    ];
    let headers = [
        Header::Plain,
        Header::Named,
        Header::Brackets,
        Header::Behind,
        Header::Line,
        Header::Comment,
        Header::None,
    ];
    for (separator, decimal_comma) in dialects {
        for (acceleration, rate, time) in units {
            for header in headers {
                ways.push(Way {
                    header,
                    separator,
                    decimal_comma,
                    acceleration,
                    rate,
                    time,
                    ..PLAIN
                });
            }
        }
    }
    let counts = [
        (16384.0, 131.0),
        (8192.0, 65.5),
        (4096.0, 32.8),
        (2048.0, 16.4),
        (16384.0, 1.0 / 0.00875),
        (8192.0, 1.0 / 0.0175),
        (4096.0, 1.0 / 0.035),
        (2048.0, 1.0 / 0.07),
    ];
    for (acceleration, rate) in counts {
        for header in [Header::Plain, Header::Named] {
            let way = Way {
                header,
                acceleration: (acceleration / G, "LSB"),
                rate: (rate * DEGREE, "LSB"),
                time: (1e6, "us"),
                ..PLAIN
            };
            ways.push(way);
        }
    }
    let harms = [
        Harm::Cut,
        Harm::Torn,
        Harm::Doubled,
        Harm::Foreign,
        Harm::NotANumber,
        Harm::Back,
        Harm::Forth,
        Harm::Preamble,
        Harm::Quoted,
        Harm::Extra,
        Harm::Mark,
        Harm::Utf16,
    ];
    for harm in harms {
        for (header, separator, line_break, decimal_comma) in [
            (Header::Plain, ",", "\n", false),
            (Header::Brackets, ";", "\r\n", true),
            (Header::Named, "\t", "\r", false),
            (Header::Line, ",", "\r\n", false),
        ] {
            let way = Way { header, separator, decimal_comma, line_break, harm, ..PLAIN };
            ways.push(way.clone());
            ways.push(Way {
                acceleration: (1.0 / G, "g"),
                rate: (DEGREE, "deg/s"),
                time: (1e3, "ms"),
                ..way
            });
        }
    }
    ways
}

/// The outcome of reading a log.
#[derive(Debug)]
enum Outcome {
    Right,
    Refused(Error),
    Wrong(String),
}

fn outcome(way: &Way, rows: &[[f64; 7]]) -> Outcome {
    let (bytes, left_out) = way.write(rows);
    match inertial::read(&bytes, &Options::default()) {
        Err(error) => Outcome::Refused(error),
        Ok(log) => compare(&log, rows, &left_out, way.acceleration.0 > 200.0)
            .map_or(Outcome::Right, Outcome::Wrong),
    }
}

/// Describes how a log deviates from these rows, if it does.
fn compare(
    log: &Inertial,
    rows: &[[f64; 7]],
    left_out: &[usize],
    is_coarse: bool,
) -> Option<String> {
    let kept: Vec<_> = (0..rows.len()).filter(|i| !left_out.contains(i)).collect();
    if log.samples.len() != kept.len() {
        return Some(format!("{} samples of {}", log.samples.len(), kept.len()));
    }
    let tolerance = if is_coarse { 1e-3 } else { 1e-6 };
    for (sample, i) in log.samples.iter().zip(kept) {
        let [t, force @ .., _, _, _] = rows[i];
        let rate = &rows[i][4..];
        let Sample { time_us, specific_force, angular_rate } = sample;
        let near = |a: &[f64], b: &[f64]| {
            a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance * (1.0 + b.abs()))
        };
        if !(near(&[*time_us as f64 * 1e-6], &[t])
            && near(specific_force, &force)
            && near(angular_rate, rate))
        {
            let told: Vec<_> = log.conclusions.iter().map(ToString::to_string).collect();
            return Some(format!("sample {i}: {sample:?} for {:?}: {}", rows[i], told.join("; ")));
        }
    }
    None
}

/// Reads a walk in all ways and counts those read right and those refused; fails at a wrong one.
fn count(name: &str, rows: &[[f64; 7]], ways: &[Way]) -> [usize; 2] {
    let mut counts = [0; 2];
    let mut refusals = std::collections::BTreeMap::new();
    for way in ways {
        match outcome(way, rows) {
            Outcome::Right => counts[0] += 1,
            Outcome::Refused(error) => {
                counts[1] += 1;
                let sentence = error.to_string();
                assert!(!sentence.contains('\n'), "{sentence}");
                let key = (
                    format!("{:?}", way.header),
                    sentence.split(", found").next().unwrap_or_default().to_owned(),
                );
                *refusals.entry(key).or_insert(0) += 1;
            }
            Outcome::Wrong(what) => panic!("{name}, {way:?}: {what}"),
        }
    }
    println!("{name}: {} right, {} refused, 0 wrong of {}", counts[0], counts[1], ways.len());
    for ((header, sentence), count) in refusals {
        println!("    {count} × {header}: {sentence}");
    }
    counts
}

#[test]
fn a_synthetic_walk_in_every_way() {
    let ways = ways();
    assert!(ways.len() >= 120, "{}", ways.len());
    let [right, _] = count("synthetic", &walk::rows(30), &ways);
    assert!(right >= 430, "{right} right");
}

#[test]
fn recorded_walks_in_every_way() {
    let ways = ways();
    for (name, bytes) in recordings::walks() {
        let chosen =
            ["exp31_imu", "exp57_100Hz", "exp36_imu", "2017-11-22-11-22-03", "2017-11-22-11-48-35"];
        if !chosen.iter().any(|part| name.contains(part)) {
            continue;
        }
        let log = plain::read(&bytes).expect(&name);
        let row = |sample: &Sample| {
            let [ax, ay, az] = sample.specific_force;
            let [gx, gy, gz] = sample.angular_rate;
            [sample.time_us as f64 * 1e-6, ax, ay, az, gx, gy, gz]
        };
        let rows: Vec<_> = log.samples.iter().map(row).collect();
        let some: Vec<_> = ways.iter().step_by(9).cloned().collect();
        count(&name, &rows, &some);
    }
}
