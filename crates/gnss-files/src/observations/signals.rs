//! The choice among a satellite's signals.

use std::collections::BTreeMap;
use std::fmt;

use crate::fields;

/// The trackings of L1 and of L2 of GPS, the best first: the clocks of satellites refer to W, which P and Y are
/// too.
const GPS: [&[u8]; 2] = [b"WPYCXSLMN", b"WPYLSXCDMN"];
/// The trackings of phases where that of the code has none.
const GPS_PHASES: [&[u8]; 2] = [b"CWPYXSLMN", b"WPYLSXCDMN"];
/// The trackings of E1 of Galileo and of E5a or E5b.
const GALILEO: [&[u8]; 2] = [b"CXBAZ", b"QXI"];

/// The two carriers on which a satellite is observed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Carriers {
    /// L1 and L2 of GPS.
    #[default]
    L1L2,
    /// E1 and E5a of Galileo.
    E1E5a,
    /// E1 and E5b of Galileo.
    E1E5b,
}

impl Carriers {
    /// The bands by their digits in RINEX 3, and the trackings of codes and of phases.
    const fn bands(self) -> ([u8; 2], [[&'static [u8]; 2]; 2]) {
        match self {
            Self::L1L2 => (*b"12", [GPS, GPS_PHASES]),
            Self::E1E5a => (*b"15", [GALILEO, GALILEO]),
            Self::E1E5b => (*b"17", [GALILEO, GALILEO]),
        }
    }
}

/// A code or phase with its band and tracking, displayed as RINEX 3 names it: `C1W`, `L2W`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Signal {
    pub(crate) phase: bool,
    /// The digit of RINEX 3.
    band: u8,
    tracking: u8,
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = if self.phase { 'L' } else { 'C' };
        write!(f, "{kind}{}{}", char::from(self.band), char::from(self.tracking))
    }
}

impl Signal {
    /// The signal of an observation code of RINEX 3 or 2; none if it is not used.
    pub(crate) fn new(system: u8, code: &[u8]) -> Option<Self> {
        let (kind, band, tracking) = match (system, code) {
            (_, &[kind @ (b'C' | b'L'), band, tracking]) => (kind, band, tracking),
            (b'G', &[b'P', band @ (b'1' | b'2')]) => (b'C', band, b'W'),
            (b'G', [b'C', b'1']) => (b'C', b'1', b'C'),
            (b'G', [b'C', b'2']) => (b'C', b'2', b'X'),
            (b'G', [b'L', b'1']) => (b'L', b'1', b'C'),
            (b'G', [b'L', b'2']) => (b'L', b'2', b'W'),
            _ => return None,
        };
        let trackings = match (system, band) {
            (b'G', b'1') => GPS[0],
            (b'G', b'2') => GPS[1],
            (b'E', b'1') => GALILEO[0],
            (b'E', b'5' | b'7') => GALILEO[1],
            _ => return None,
        };
        trackings.contains(&tracking).then_some(Self { phase: kind == b'L', band, tracking })
    }

    /// Its carrier's frequency, Hz.
    #[cfg(feature = "rtcm")]
    pub(crate) const fn frequency(self) -> f64 {
        match self.band {
            b'1' => 1_575.42e6,
            b'2' => 1_227.60e6,
            b'5' => 1_176.45e6,
            _ => 1_207.14e6,
        }
    }

    /// The first carrier or the second.
    pub(super) const fn place(self) -> usize {
        if self.band == b'1' { 0 } else { 1 }
    }

    /// Whether the clocks of satellites refer to this code, as far as anybody tells them apart.
    const fn is_reference(self) -> bool {
        match self.band {
            b'1' | b'2' => matches!(self.tracking, b'W' | b'P' | b'Y'),
            band => band == b'5',
        }
    }

    /// The code of the same carrier to which the clocks of satellites refer; none of a carrier to which they do not.
    pub(crate) const fn reference(self, carriers: Carriers) -> Option<Self> {
        match (carriers, self.is_reference()) {
            (Carriers::L1L2, true) | (Carriers::E1E5a, _) => Some(self),
            (Carriers::L1L2, false) => Some(Self { tracking: b'W', ..self }),
            (Carriers::E1E5b, _) => None,
        }
    }
}

/// An observation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Raw {
    pub(crate) signal: Signal,
    pub(crate) value: f64,
    pub(crate) lock_lost: bool,
}

/// Number of observations of each signal of each satellite.
#[derive(Debug, Default)]
pub(super) struct Seen(BTreeMap<u8, Vec<(Signal, usize)>>);

impl Seen {
    pub(super) fn count(&mut self, prn: u8, raw: &[Raw]) {
        let counts = self.0.entry(prn).or_default();
        for &Raw { signal, .. } in raw {
            match counts.iter_mut().find(|(other, _)| *other == signal) {
                Some((_, count)) => *count += 1,
                None => counts.push((signal, 1)),
            }
        }
    }

    pub(super) fn choose(&self) -> BTreeMap<u8, Signals> {
        let galileo = self.galileo();
        let carriers = |number| if number < fields::GALILEO { Carriers::L1L2 } else { galileo };
        let choose =
            |(&number, counts): (&u8, &Vec<_>)| (number, Signals::choose(counts, carriers(number)));
        self.0.iter().map(choose).collect()
    }

    /// The carriers of Galileo: E5a, unless E5b is observed more than twice as often.
    fn galileo(&self) -> Carriers {
        let count = |band| -> usize {
            let all = self.0.range(fields::GALILEO..).flat_map(|(_, counts)| counts);
            all.filter(|(signal, _)| signal.band == band).map(|(_, count)| count).sum()
        };
        if count(b'7') > 2 * count(b'5') { Carriers::E1E5b } else { Carriers::E1E5a }
    }
}

/// The signals taken from a satellite, the same in all epochs: between signals are biases of up to some metres.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Signals {
    /// The carriers.
    pub carriers: Carriers,
    /// Codes on both.
    pub code: [Option<Signal>; 2],
    /// Phases on both.
    pub phase: [Option<Signal>; 2],
}

impl Signals {
    /// The best of those that are there at least half as often as the most frequent one.
    fn choose(counts: &[(Signal, usize)], carriers: Carriers) -> Self {
        let count = |signal: &Signal| {
            counts.iter().find(|(other, _)| other == signal).map_or(0, |&(_, count)| count)
        };
        let best = |phase, band, first: Option<u8>, order: &[u8]| {
            let signal = |tracking| Signal { phase, band, tracking };
            let most = order.iter().map(|&tracking| count(&signal(tracking))).max()?;
            let often = |signal: &Signal| count(signal) > 0 && 2 * count(signal) >= most;
            first.into_iter().chain(order.iter().copied()).map(signal).find(often)
        };
        let (bands, [codes, phases]) = carriers.bands();
        let mut chosen = Self { carriers, ..Self::default() };
        for (place, band) in bands.into_iter().enumerate() {
            chosen.code[place] = best(false, band, None, codes[place]);
            let tracking = chosen.code[place].map(|code| code.tracking);
            chosen.phase[place] = best(true, band, tracking, phases[place]);
        }
        chosen
    }

    /// Whether the clocks of satellites refer to both codes.
    pub fn are_reference(&self) -> bool {
        self.code
            .iter()
            .all(|code| code.is_some_and(|code| code.reference(self.carriers) == Some(code)))
    }

    /// Sentences about the codes of satellites without known biases to which the clocks of satellites do not refer.
    pub(super) fn warnings<'a>(signals: impl Iterator<Item = (&'a u8, &'a Self)>) -> Vec<String> {
        let mut others = BTreeMap::<Signal, Vec<String>>::new();
        for (number, signals) in signals {
            if signals.code.contains(&None) {
                continue;
            }
            // Those of Galileo's E1 are nearly the same.
            let first = usize::from(signals.carriers != Carriers::L1L2);
            for code in signals.code.into_iter().skip(first).flatten() {
                if !code.is_reference() {
                    others.entry(code).or_default().push(fields::satellite_name(*number));
                }
            }
        }
        let sentence = |(code, satellites): (Signal, Vec<String>)| {
            let satellites = satellites.join(" ");
            let usual = match code.band {
                b'1' => "C1W",
                b'2' => "C2W",
                _ => "those of E5a",
            };
            format!(
                "{code} is taken instead of {usual}, to which satellite clocks refer: biases of up to some \
                 metres are not corrected ({satellites})"
            )
        };
        others.into_iter().map(sentence).collect()
    }
}
