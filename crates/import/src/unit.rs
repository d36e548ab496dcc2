//! Units of acceleration, angular rate and time, and the ways in which they are written.

use std::f64::consts::PI;
use std::fmt;

/// Standard gravity, m/s².
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// A measured quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Specific force, in m/s².
    Acceleration,
    /// Angular rate, in rad/s.
    Rate,
    /// Time, in s.
    Time,
    /// Length, in m.
    Length,
    /// Speed, in m/s.
    Speed,
    /// Level or loss, in dB.
    Level,
    /// Latitude or longitude, in degrees.
    Angle,
    /// Attitude, incidence or deflection, in rad.
    Inclination,
    /// Part of a whole, 0 to 1.
    Share,
}

/// A unit of one [`Quantity`].
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// The factor that converts a value to the quantity's SI unit.
    pub scale: f64,
    /// The symbol of the unit.
    pub name: String,
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}

/// The ways to write a unit (in lower case, without blanks and powers), its scale, and the symbol under which it is
/// reported.
type Known = (&'static [&'static str], f64, &'static str);

const ACCELERATION: [Known; 6] = [
    (
        &["m/s2", "m/s/s", "ms-2", "m.s-2", "m*s-2", "mps2", "mpss", "mss", "ms2", "m/sec2", "si"],
        1.0,
        "m/s²",
    ),
    (&["g", "gs", "gn", "g0", "gforce"], STANDARD_GRAVITY, "g"),
    (&["mg", "mgs", "millig", "milli-g"], STANDARD_GRAVITY * 1e-3, "mg"),
    (&["ug", "microg"], STANDARD_GRAVITY * 1e-6, "µg"),
    (&["cm/s2", "gal", "cmss"], 1e-2, "cm/s²"),
    (&["mm/s2", "mmss"], 1e-3, "mm/s²"),
];

const RATE: [Known; 4] = [
    (
        &["rad/s", "rads", "rad/sec", "rads-1", "rad.s-1", "radps", "radpersec", "radians/s", "si"],
        1.0,
        "rad/s",
    ),
    (
        &[
            "deg/s",
            "dps",
            "degs",
            "deg/sec",
            "degsec",
            "degps",
            "degs-1",
            "deg.s-1",
            "degpersec",
            "degree/s",
            "degrees/s",
            "degrees/sec",
            "degrees/second",
            "degpersecond",
        ],
        PI / 180.0,
        "°/s",
    ),
    (&["mdps", "mdeg/s", "millideg/s", "mdegs"], PI / 180.0 * 1e-3, "m°/s"),
    (&["mrad/s", "mrads"], 1e-3, "mrad/s"),
];

const TIME: [Known; 4] = [
    (&["s", "sec", "secs", "second", "seconds"], 1.0, "s"),
    (&["ms", "msec", "msecs", "millis", "millisec", "milliseconds", "millisecond"], 1e-3, "ms"),
    (&["us", "usec", "usecs", "micros", "microsec", "microseconds", "microsecond"], 1e-6, "µs"),
    (&["ns", "nsec", "nsecs", "nanos", "nanosec", "nanoseconds", "nanosecond"], 1e-9, "ns"),
];

const LENGTH: [Known; 6] = [
    (&["m", "meter", "meters", "metre", "metres"], 1.0, "m"),
    (&["cm", "centimeter", "centimeters", "centimetre", "centimetres"], 1e-2, "cm"),
    (&["mm", "millimeter", "millimeters", "millimetre", "millimetres"], 1e-3, "mm"),
    (&["km", "kilometer", "kilometers", "kilometre", "kilometres"], 1e3, "km"),
    (&["ft", "foot", "feet"], 0.3048, "ft"),
    (&["in", "inch", "inches"], 0.0254, "in"),
];

const SPEED: [Known; 6] = [
    (&["m/s", "mps", "ms-1", "m.s-1", "m/sec"], 1.0, "m/s"),
    (&["cm/s", "cmps", "cm/sec"], 1e-2, "cm/s"),
    (&["mm/s", "mmps", "mm/sec"], 1e-3, "mm/s"),
    (&["km/h", "kmh", "kph"], 1.0 / 3.6, "km/h"),
    (&["ft/s", "fps"], 0.3048, "ft/s"),
    (&["mph"], 0.447_04, "mph"),
];

const ANGLE: [Known; 3] = [
    (&["deg", "degs", "degree", "degrees"], 1.0, "°"),
    (&["rad", "radian", "radians"], 180.0 / PI, "rad"),
    (&["1e7", "e7", "dege7", "1e-7deg"], 1e-7, "10⁻⁷ °"),
];

const INCLINATION: [Known; 3] = [
    (&["rad", "radian", "radians"], 1.0, "rad"),
    (&["deg", "degs", "degree", "degrees"], PI / 180.0, "°"),
    (&["cdeg", "centidegree", "centidegrees"], PI / 18_000.0, "10⁻² °"),
];

const SHARE: [Known; 2] = [(&["1", "share"], 1.0, "parts of 1"), (&["%", "percent"], 1e-2, "%")];

const LEVEL: [Known; 1] = [(&["db", "dbm"], 1.0, "dB")];

impl Unit {
    pub(crate) fn new(scale: f64, name: impl Into<String>) -> Self {
        Self { scale, name: name.into() }
    }

    /// Parses a unit as written in a header: `m/s^2`, `deg/s`, `ms`.
    pub fn read(quantity: Quantity, text: &str) -> Option<Self> {
        let text = simplified(text);
        let (_, scale, name) =
            table(quantity).iter().find(|unit| unit.0.contains(&text.as_str()))?;
        Some(Self::new(*scale, *name))
    }

    /// Parses a unit with an optional factor, as options give it: `-g`, `0.07deg/s`, `131lsb` for 131 counts per °/s,
    /// `16384lsb` for 16384 counts per g.
    pub fn read_scaled(quantity: Quantity, text: &str) -> Option<Self> {
        let text = text.trim();
        let (factor, rest) = match fast_float2::parse_partial::<f64, _>(text) {
            Ok((factor, length)) => (factor, text.get(length..)?),
            Err(_) => text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest)),
        };
        if !factor.is_normal() {
            return None;
        }
        if matches!(simplified(rest).as_str(), "lsb" | "counts" | "count") {
            return counts(quantity, factor);
        }
        let unit = Self::read(quantity, rest)?;
        let name = match factor {
            1.0 => unit.name,
            -1.0 => format!("−{unit}"),
            _ => format!("{factor} {unit}"),
        };
        Some(Self::new(factor * unit.scale, name))
    }
}

/// The unit of a sensor with `each` counts per g, or per °/s.
pub(crate) fn counts(quantity: Quantity, each: f64) -> Option<Unit> {
    match quantity {
        Quantity::Acceleration => {
            Some(Unit::new(STANDARD_GRAVITY / each, format!("counts of 1/{each} g")))
        }
        Quantity::Rate => Some(Unit::new(PI / 180.0 / each, format!("counts of 1/{each} °/s"))),
        _ => None,
    }
}

fn table(quantity: Quantity) -> &'static [Known] {
    match quantity {
        Quantity::Acceleration => &ACCELERATION,
        Quantity::Rate => &RATE,
        Quantity::Time => &TIME,
        Quantity::Length => &LENGTH,
        Quantity::Speed => &SPEED,
        Quantity::Level => &LEVEL,
        Quantity::Angle => &ANGLE,
        Quantity::Inclination => &INCLINATION,
        Quantity::Share => &SHARE,
    }
}

/// The text in lower case, without blanks, power signs and brackets; `°` becomes `deg`, `µ` becomes `u`.
fn simplified(text: &str) -> String {
    let mut simple = String::new();
    for letter in text.trim().chars() {
        match letter {
            '²' => simple.push('2'),
            '°' | 'º' => simple.push_str("deg"),
            'µ' | 'μ' => simple.push('u'),
            '−' | '⁻' => simple.push('-'),
            '¹' => simple.push('1'),
            '·' => simple.push('.'),
            '^' | '_' | '[' | ']' | '(' | ')' | '{' | '}' => {}
            letter if letter.is_whitespace() => {}
            letter => simple.extend(letter.to_lowercase()),
        }
    }
    simple.replace("**", "")
}

/// Whether a word is a unit of any sensor that a log may hold.
pub(crate) fn is_known(text: &str) -> bool {
    const OTHERS: [&str; 16] = [
        "ut", "nt", "mgauss", "gauss", "ga", "degc", "c", "k", "pa", "hpa", "kpa", "v", "mv", "hz",
        "lsb", "%",
    ];
    const ALL: [Quantity; 8] = [
        Quantity::Acceleration,
        Quantity::Rate,
        Quantity::Time,
        Quantity::Length,
        Quantity::Speed,
        Quantity::Level,
        Quantity::Angle,
        Quantity::Inclination,
    ];
    ALL.into_iter().any(|quantity| Unit::read(quantity, text).is_some())
        || OTHERS.contains(&simplified(text).as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_as_people_write_them() {
        for (quantity, text, name) in [
            (Quantity::Acceleration, "m/s^2", "m/s²"),
            (Quantity::Acceleration, "m/s²", "m/s²"),
            (Quantity::Acceleration, "m·s⁻²", "m/s²"),
            (Quantity::Acceleration, "m/s**2", "m/s²"),
            (Quantity::Acceleration, "G", "g"),
            (Quantity::Rate, "°/s", "°/s"),
            (Quantity::Rate, "Deg/s", "°/s"),
            (Quantity::Rate, "rad s^-1", "rad/s"),
            (Quantity::Time, "μs", "µs"),
        ] {
            assert_eq!(
                Unit::read(quantity, text).map(|unit| unit.name),
                Some(name.into()),
                "{text}"
            );
        }
        assert_eq!(Unit::read(Quantity::Time, "g"), None);
    }

    #[test]
    fn options_may_give_a_factor() {
        let scale = |quantity, text| Unit::read_scaled(quantity, text).map(|unit| unit.scale);
        assert_eq!(scale(Quantity::Acceleration, "-g"), Some(-STANDARD_GRAVITY));
        assert_eq!(scale(Quantity::Rate, "0.07deg/s"), Some(0.07 * PI / 180.0));
        assert_eq!(scale(Quantity::Acceleration, "16384lsb"), Some(STANDARD_GRAVITY / 16384.0));
        assert_eq!(scale(Quantity::Time, "0s"), None);
        assert_eq!(scale(Quantity::Time, "5lsb"), None);
    }
}
