//! The choice among a satellite's signals.

use std::collections::BTreeMap;
use std::fmt;

/// The trackings of L1 and of L2, the best first: the clocks of satellites refer to W, which P and Y are
/// too.
const TRACKINGS: [&[u8]; 2] = [b"WPYCXSLMN", b"WPYLSXCDMN"];
/// The trackings of phases where that of the code has none.
const PHASE_TRACKINGS: [&[u8]; 2] = [b"CWPYXSLMN", b"WPYLSXCDMN"];

/// A code or phase on L1 or L2 with its tracking, displayed as RINEX 3 names it: `C1W`, `L2W`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Signal {
    pub(super) phase: bool,
    /// 0 for L1, 1 for L2.
    pub(super) band: usize,
    tracking: u8,
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = if self.phase { 'L' } else { 'C' };
        write!(f, "{kind}{}{}", self.band + 1, char::from(self.tracking))
    }
}

impl Signal {
    /// The signal of an observation code of RINEX 3 or 2; none if it is not used.
    pub(super) fn new(code: &[u8]) -> Option<Self> {
        let (kind, band, tracking) = match *code {
            [kind @ (b'C' | b'L'), band @ (b'1' | b'2'), tracking] => (kind, band, tracking),
            [b'P', band @ (b'1' | b'2')] => (b'C', band, b'W'),
            [b'C', b'1'] => (b'C', b'1', b'C'),
            [b'C', b'2'] => (b'C', b'2', b'X'),
            [b'L', b'1'] => (b'L', b'1', b'C'),
            [b'L', b'2'] => (b'L', b'2', b'W'),
            _ => return None,
        };
        let band = usize::from(band - b'1');
        let known = TRACKINGS[band].contains(&tracking);
        known.then_some(Self { phase: kind == b'L', band, tracking })
    }
}

/// An observation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Raw {
    pub(super) signal: Signal,
    pub(super) value: f64,
    pub(super) lock_lost: bool,
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
        self.0.iter().map(|(&prn, counts)| (prn, Signals::choose(counts))).collect()
    }
}

/// The signals taken from a satellite, the same in all epochs: between signals are biases of up to some metres.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Signals {
    /// Codes on L1 and L2.
    pub code: [Option<Signal>; 2],
    /// Phases on L1 and L2.
    pub phase: [Option<Signal>; 2],
}

impl Signals {
    /// The best of those that are there at least half as often as the most frequent one.
    fn choose(counts: &[(Signal, usize)]) -> Self {
        let count = |signal: &Signal| {
            counts.iter().find(|(other, _)| other == signal).map_or(0, |&(_, count)| count)
        };
        let best = |phase, band, first: Option<u8>, order: &[u8]| {
            let signal = |tracking| Signal { phase, band, tracking };
            let most = order.iter().map(|&tracking| count(&signal(tracking))).max()?;
            let often = |signal: &Signal| count(signal) > 0 && 2 * count(signal) >= most;
            first.into_iter().chain(order.iter().copied()).map(signal).find(often)
        };
        let mut chosen = Self::default();
        for band in [0, 1] {
            chosen.code[band] = best(false, band, None, TRACKINGS[band]);
            let tracking = chosen.code[band].map(|code| code.tracking);
            chosen.phase[band] = best(true, band, tracking, PHASE_TRACKINGS[band]);
        }
        chosen
    }

    /// Sentences about codes to which the clocks of satellites do not refer.
    pub(super) fn warnings(signals: &BTreeMap<u8, Self>) -> Vec<String> {
        let mut others = BTreeMap::<Signal, Vec<String>>::new();
        for (prn, signals) in signals {
            for code in signals.code.into_iter().flatten() {
                if !matches!(code.tracking, b'W' | b'P' | b'Y') {
                    others.entry(code).or_default().push(format!("G{prn:02}"));
                }
            }
        }
        let sentence = |(code, satellites): (Signal, Vec<String>)| {
            let satellites = satellites.join(" ");
            let band = code.band + 1;
            format!(
                "{code} is taken instead of C{band}W, to which satellite clocks refer: biases of up to some \
                 metres are not corrected ({satellites})"
            )
        };
        others.into_iter().map(sentence).collect()
    }
}
