//! Selection of the signals of each satellite.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::RangeInclusive;

use crate::system::{System, satellite_name};

/// The tracking codes of GPS L1 and L2, best first: satellite clocks refer to W, for which P and Y also stand.
const GPS: [&[u8]; 2] = [b"WPYCXSLMN", b"WPYLSXCDMN"];
/// The tracking codes of GPS phases, best first, for a band in which the code's own tracking has no phase.
const GPS_PHASES: [&[u8]; 2] = [b"CWPYXSLMN", b"WPYLSXCDMN"];
/// The tracking codes of Galileo E1, and of E5a or E5b, best first.
const GALILEO: [&[u8]; 2] = [b"CXBAZ", b"QXI"];
/// The tracking codes of GLONASS G1 and G2, best first: satellite clocks refer to P.
const GLONASS: &[u8] = b"PC";
/// The tracking codes of BeiDou B1I, B2I and B3I, best first.
const BEIDOU: &[u8] = b"IXQ";
/// The tracking codes of BeiDou B1C and B2a, best first.
const BEIDOU_3: &[u8] = b"PXD";

/// The frequency channels of GLONASS.
pub(crate) const CHANNELS: RangeInclusive<i8> = -7..=6;

/// The ratio of a GLONASS channel's frequencies to those of channel 0 (GLONASS ICD L1, L2, 3.3.1.1).
#[cfg(feature = "rtcm")]
pub(crate) fn channel_scale(channel: i8) -> f64 {
    1.0 + f64::from(channel) / 2_848.0
}

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
    /// G1 and G2 of GLONASS.
    G1G2 {
        /// The satellite's frequency channel, −7 to 6.
        channel: i8,
    },
    /// B1I and B3I of BeiDou.
    B1B3,
    /// B1I and B2I of BeiDou.
    B1B2,
    /// B1C and B2a of BeiDou.
    B1cB2a,
}

impl Carriers {
    /// The system whose satellites transmit the carriers.
    pub const fn system(self) -> System {
        match self {
            Self::L1L2 => System::Gps,
            Self::E1E5a | Self::E1E5b => System::Galileo,
            Self::G1G2 { .. } => System::Glonass,
            Self::B1B3 | Self::B1B2 | Self::B1cB2a => System::BeiDou,
        }
    }

    /// The bands, as digits of RINEX 3.
    pub(crate) const fn bands(self) -> [u8; 2] {
        match self {
            Self::L1L2 | Self::G1G2 { .. } => *b"12",
            Self::E1E5a | Self::B1cB2a => *b"15",
            Self::E1E5b => *b"17",
            Self::B1B3 => *b"26",
            Self::B1B2 => *b"27",
        }
    }

    /// The tracking codes of the two codes and of the two phases, best first.
    const fn trackings(self) -> [[&'static [u8]; 2]; 2] {
        match self {
            Self::L1L2 => [GPS, GPS_PHASES],
            Self::E1E5a | Self::E1E5b => [GALILEO; 2],
            Self::G1G2 { .. } => [[GLONASS; 2]; 2],
            Self::B1B3 | Self::B1B2 => [[BEIDOU; 2]; 2],
            Self::B1cB2a => [[BEIDOU_3; 2]; 2],
        }
    }
}

/// A code or phase with its band and tracking, displayed as RINEX 3 names it: `C1W`, `L2W`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Signal {
    pub(crate) phase: bool,
    /// The band, as a digit of RINEX 3.
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
    /// The signal of a RINEX 3 or RINEX 2 observation code; `None` if it is not used.
    pub(crate) fn new(system: u8, code: &[u8]) -> Option<Self> {
        let (kind, band, tracking) = match (system, code) {
            // RINEX 3.02 lists B1I on band 1, where BeiDou otherwise has no signal with these tracking codes.
            (b'C', &[kind @ (b'C' | b'L'), b'1', tracking @ (b'I' | b'Q')]) => {
                (kind, b'2', tracking)
            }
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
            (b'R', b'1' | b'2') => GLONASS,
            (b'C', b'2' | b'6' | b'7') => BEIDOU,
            (b'C', b'1' | b'5') => BEIDOU_3,
            _ => return None,
        };
        trackings.contains(&tracking).then_some(Self { phase: kind == b'L', band, tracking })
    }

    /// The carrier frequency, Hz; for GLONASS that of channel 0.
    #[cfg(feature = "rtcm")]
    pub(crate) const fn frequency(self, system: System) -> f64 {
        match (system, self.band) {
            (System::Glonass, b'1') => 1_602e6,
            (System::Glonass, _) => 1_246e6,
            (System::BeiDou, b'2') => 1_561.098e6,
            (_, b'1') => 1_575.42e6,
            (_, b'2') => 1_227.60e6,
            (_, b'5') => 1_176.45e6,
            (_, b'6') => 1_268.52e6,
            _ => 1_207.14e6,
        }
    }

    /// The code on the same carrier to which satellite clocks refer, as far as codes are told apart; `None` for a
    /// carrier to which they do not refer.
    pub(crate) const fn reference(self, carriers: Carriers) -> Option<Self> {
        match (carriers, self.tracking) {
            (Carriers::L1L2, b'W' | b'P' | b'Y') | (Carriers::E1E5a | Carriers::B1B3, _) => {
                Some(self)
            }
            (Carriers::L1L2, _) => Some(Self { tracking: b'W', ..self }),
            (Carriers::G1G2 { .. }, _) => Some(Self { tracking: b'P', ..self }),
            (Carriers::E1E5b | Carriers::B1B2 | Carriers::B1cB2a, _) => None,
        }
    }
}

/// An observation of one signal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Raw {
    pub(crate) signal: Signal,
    pub(crate) value: f64,
    pub(crate) lock_lost: bool,
}

/// The number of observations of each signal, by satellite.
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

    /// Chooses the signals of each satellite, without GLONASS satellites that are not among the `channels`.
    pub(super) fn choose(&self, channels: &BTreeMap<u8, i8>) -> BTreeMap<u8, Signals> {
        let (galileo, beidou) = (self.galileo(), self.beidou());
        let carriers = |number| match System::of(number) {
            System::Gps => Some(Carriers::L1L2),
            System::Galileo => Some(galileo),
            System::Glonass => channels.get(&number).map(|&channel| Carriers::G1G2 { channel }),
            System::BeiDou => Some(beidou),
        };
        let choose = |(&number, counts): (&u8, &Vec<_>)| {
            Some((number, Signals::choose(counts, carriers(number)?)))
        };
        self.0.iter().filter_map(choose).collect()
    }

    /// The GLONASS satellites that are missing from `channels`.
    pub(super) fn without_channel(&self, channels: &BTreeMap<u8, i8>) -> impl Iterator<Item = u8> {
        let of_glonass = self.0.keys().filter(|number| System::of(**number) == System::Glonass);
        of_glonass.copied().filter(|number| !channels.contains_key(number))
    }

    /// The number of observations in a band of a system.
    fn count_of(&self, system: System, band: u8) -> usize {
        let all = self.0.iter().filter(|(number, _)| System::of(**number) == system);
        let all = all.flat_map(|(_, counts)| counts);
        all.filter(|(signal, _)| signal.band == band).map(|(_, count)| count).sum()
    }

    /// The carriers of Galileo: E5a, unless E5b is observed more than twice as often.
    fn galileo(&self) -> Carriers {
        let [a, b] = [b'5', b'7'].map(|band| self.count_of(System::Galileo, band));
        if b > 2 * a { Carriers::E1E5b } else { Carriers::E1E5a }
    }

    /// The most observed pair of BeiDou carriers; of equals, the first of B1I and B3I, B1I and B2I, B1C and B2a.
    fn beidou(&self) -> Carriers {
        let pairs = [Carriers::B1cB2a, Carriers::B1B2, Carriers::B1B3];
        let count = |pair: &Carriers| {
            let [first, second] = pair.bands().map(|band| self.count_of(System::BeiDou, band));
            first.min(second)
        };
        pairs.into_iter().max_by_key(count).unwrap_or(Carriers::B1B3)
    }
}

/// The signals taken from a satellite, the same in all epochs, because biases of up to some metres lie between signals.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Signals {
    /// The carriers.
    pub carriers: Carriers,
    /// The codes on both carriers.
    pub code: [Option<Signal>; 2],
    /// The phases on both carriers.
    pub phase: [Option<Signal>; 2],
}

impl Signals {
    /// Chooses the best of the signals that occur at least half as often as the most frequent one.
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
        let [codes, phases] = carriers.trackings();
        let mut chosen = Self { carriers, ..Self::default() };
        for (place, band) in carriers.bands().into_iter().enumerate() {
            chosen.code[place] = best(false, band, None, codes[place]);
            let tracking = chosen.code[place].map(|code| code.tracking);
            chosen.phase[place] = best(true, band, tracking, phases[place]);
        }
        chosen
    }

    /// Whether satellite clocks refer to both codes.
    pub fn are_reference(&self) -> bool {
        self.code
            .iter()
            .all(|code| code.is_some_and(|code| code.reference(self.carriers) == Some(code)))
    }

    /// Warnings about the codes, of satellites without known biases, to which satellite clocks do not refer.
    pub(super) fn warnings<'a>(signals: impl Iterator<Item = (&'a u8, &'a Self)>) -> Vec<String> {
        let mut others = BTreeMap::<Signal, Vec<String>>::new();
        for (number, signals) in signals {
            if signals.code.contains(&None) {
                continue;
            }
            // The codes of Galileo E1 are nearly the same; those of GLONASS and BeiDou carry little weight anyway.
            let first = match signals.carriers.system() {
                System::Gps => 0,
                System::Galileo => 1,
                System::Glonass | System::BeiDou => continue,
            };
            for code in signals.code.into_iter().skip(first).flatten() {
                if code.reference(signals.carriers) != Some(code) {
                    others.entry(code).or_default().push(satellite_name(*number));
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
