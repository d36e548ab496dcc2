//! Corrections of broadcast orbits, clocks and codes (state-space representation, SSR), as services send them in RTCM 3: of
//! GPS in messages 1057 to 1060, of Galileo in 1240 to 1243, and of both in message 4076.
//!
//! Sources: RTCM 10403.3, 3.5.13 (GPS; Galileo's messages have the same fields but for the number of the issue); IGS SSR 1.00
//! (4076).

use crate::Bits;

/// The seconds between two corrections, by index. (RTCM: DF391; IGS: IDF004.)
const INTERVALS: [f64; 16] = [
    1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 240.0, 300.0, 600.0, 900.0, 1_800.0, 3_600.0,
    7_200.0, 10_800.0,
];
/// The first message of GPS and of Galileo, and that of the IGS.
const OF_GPS: u64 = 1057;
const OF_GALILEO: u64 = 1240;
const OF_IGS: u64 = 4076;
/// The first subtype of the IGS for GPS and for Galileo.
const IGS_GPS: u64 = 21;
const IGS_GALILEO: u64 = 61;
/// The length of a week, s.
const WEEK: f64 = 604_800.0;
/// Band and attribute, as in RINEX 3, of the signals of code biases by number. (RTCM: DF380, DF382; IGS: IDF023.)
const GPS_SIGNALS: [&[u8; 2]; 20] = [
    b"1C", b"1P", b"1W", b"1Y", b"1M", b"2C", b"2D", b"2S", b"2L", b"2X", b"2P", b"2W", b"2Y",
    b"2M", b"5I", b"5Q", b"5X", b"1S", b"1L", b"1X",
];
const GALILEO_SIGNALS: [&[u8; 2]; 19] = [
    b"1A", b"1B", b"1C", b"1X", b"1Z", b"5I", b"5Q", b"5X", b"7I", b"7Q", b"7X", b"8I", b"8Q",
    b"8X", b"6A", b"6B", b"6C", b"6X", b"6Z",
];
/// Units of distances, m, of their rates, m/s, and of the rate's rate, m/s².
const RADIAL: f64 = 1e-4;
const TANGENTIAL: f64 = 4e-4;
const RADIAL_RATE: f64 = 1e-6;
const TANGENTIAL_RATE: f64 = 4e-6;
const CLOCK: f64 = 1e-4;
const CLOCK_RATE: f64 = 1e-6;
const CLOCK_AGEING: f64 = 2e-8;
const CODE: f64 = 0.01;

/// The satellite system of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum System {
    /// GPS. Corrections refer to LNAV.
    Gps,
    /// Galileo. Corrections refer to I/NAV.
    Galileo,
}

/// The correction of a satellite's orbit: what is to be subtracted from the broadcast position.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Orbit {
    /// The issue of the ephemeris that is corrected.
    issue: u16,
    /// The transmitted bits of its number, the lowest ones.
    issue_mask: u16,
    /// Radial, along-track and cross-track, m, at the reference time.
    offset: [f64; 3],
    /// The rates of change, m/s.
    rate: [f64; 3],
}

impl Orbit {
    /// Whether the correction is one of the ephemeris of an issue (IODE, `IODnav`).
    pub const fn is_of(&self, issue: u16) -> bool {
        self.issue == issue & self.issue_mask
    }

    /// Radial, along-track and cross-track, m, some seconds after the reference time.
    pub fn at(&self, elapsed: f64) -> [f64; 3] {
        let [radial, along, cross] = self.offset;
        let [of_radial, of_along, of_cross] = self.rate;
        [radial + of_radial * elapsed, along + of_along * elapsed, cross + of_cross * elapsed]
    }
}

/// The correction of a satellite's clock: what is to be added to the broadcast clock, m, and its derivatives at the
/// reference time, m/s and m/s².
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Clock([f64; 3]);

impl Clock {
    /// The correction some seconds after the reference time, m.
    pub fn at(&self, elapsed: f64) -> f64 {
        let [offset, rate, ageing] = self.0;
        offset + elapsed * (rate + elapsed * ageing)
    }
}

/// A correction of one satellite.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Correction {
    /// The orbit.
    Orbit(Orbit),
    /// The clock.
    Clock(Clock),
    /// A code.
    Code {
        /// Band and attribute of the signal, as in RINEX 3: `*b"1C"`.
        signal: [u8; 2],
        /// What is to be added to the observed code, m.
        bias: f64,
    },
}

/// The content of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Content {
    Orbits,
    Clocks,
    Codes,
    OrbitsAndClocks,
}

/// What all corrections of a message have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Header {
    /// The satellite system.
    pub system: System,
    /// The time from which the corrections apply, s of the GPS week.
    pub second: f64,
    /// The time between two such messages, s.
    pub interval: f64,
    /// The time to which the values refer, s of the GPS week: the middle of the interval, unless that is a second.
    pub reference: f64,
    /// The numbers of the service and of its solution: corrections of different ones do not fit each other.
    pub provider: (u16, u8),
    /// The number of the service's configuration (IOD SSR): an orbit and a clock of different ones do not fit each other.
    pub configuration: u8,
}

/// A message with corrections of the satellites of one system.
#[derive(Debug, Clone, Copy)]
pub struct Message<'a> {
    /// What all of its corrections have in common.
    pub header: Header,
    content: Content,
    issue_bits: usize,
    satellites: u64,
    bits: Bits<'a>,
    end: usize,
}

impl<'a> Message<'a> {
    /// The message of an RTCM frame, from the [data](crate::frame_data) of the frame. `None` for another message, and for orbits
    /// that refer to a regional datum: positions would be decimetres off those of others.
    pub fn from_data(data: &'a [u8]) -> Option<Self> {
        let mut bits = Bits::at(data, 0);
        let number = bits.integer(12);
        let is_igs = number == OF_IGS;
        let (system, content) = if is_igs {
            // The version.
            bits.skip(3);
            of_igs(bits.integer(8))?
        } else {
            of_rtcm(number)?
        };
        let second = bits.integer(20) as f64;
        let interval = *INTERVALS.get(bits.integer(4) as usize)?;
        // Whether another message belongs to it.
        bits.skip(1);
        let has_orbits = matches!(content, Content::Orbits | Content::OrbitsAndClocks);
        let is_regional =
            |bits: &mut Bits<'_>, is_here: bool| is_here && has_orbits && bits.integer(1) == 1;
        let regional_by_rtcm = is_regional(&mut bits, !is_igs);
        let configuration = bits.integer(4) as u8;
        let provider = (bits.integer(16) as u16, bits.integer(4) as u8);
        if regional_by_rtcm || is_regional(&mut bits, is_igs) || second >= WEEK {
            return None;
        }
        let satellites = bits.integer(6);
        let reference = if interval > 1.0 { second + interval / 2.0 } else { second };
        Some(Self {
            header: Header { system, second, interval, reference, provider, configuration },
            content,
            issue_bits: if system == System::Galileo && !is_igs { 10 } else { 8 },
            satellites,
            bits,
            end: 8 * data.len(),
        })
    }

    /// The corrections, each with the number of its satellite within the system. Of a message that ends too early those before the
    /// end; values that are said to be unknown are left out.
    pub const fn corrections(&self) -> Corrections<'a> {
        let Self { header, content, issue_bits, satellites, bits, end } = *self;
        Corrections {
            system: header.system,
            content,
            issue_bits,
            satellites,
            bits,
            end,
            satellite: 0,
            clock_follows: false,
            codes: 0,
        }
    }
}

const fn of_rtcm(number: u64) -> Option<(System, Content)> {
    let (system, first) =
        if number < OF_GALILEO { (System::Gps, OF_GPS) } else { (System::Galileo, OF_GALILEO) };
    let content = match number.wrapping_sub(first) {
        0 => Content::Orbits,
        1 => Content::Clocks,
        2 => Content::Codes,
        3 => Content::OrbitsAndClocks,
        _ => return None,
    };
    Some((system, content))
}

const fn of_igs(subtype: u64) -> Option<(System, Content)> {
    let (system, first) =
        if subtype < IGS_GALILEO { (System::Gps, IGS_GPS) } else { (System::Galileo, IGS_GALILEO) };
    let content = match subtype.wrapping_sub(first) {
        0 => Content::Orbits,
        1 => Content::Clocks,
        2 => Content::OrbitsAndClocks,
        4 => Content::Codes,
        _ => return None,
    };
    Some((system, content))
}

/// The corrections of a message: [`Message::corrections`].
#[derive(Debug, Clone)]
pub struct Corrections<'a> {
    system: System,
    content: Content,
    issue_bits: usize,
    /// The satellites that are left.
    satellites: u64,
    bits: Bits<'a>,
    /// The length of the message, bits.
    end: usize,
    satellite: u8,
    clock_follows: bool,
    /// The codes of this satellite that are left.
    codes: u64,
}

impl Corrections<'_> {
    /// Reads a number in two's complement; `None` for the one without a positive counterpart, which stands for an unknown
    /// value.
    fn number(&mut self, bits: usize, unit: f64) -> Option<f64> {
        let value = self.bits.signed(bits, 0);
        let unknown = -((1_u64 << (bits - 1)) as f64);
        (value > unknown).then_some(unit * value)
    }

    fn orbit(&mut self) -> Option<Correction> {
        let issue = self.bits.integer(self.issue_bits) as u16;
        let offset = [(22, RADIAL), (20, TANGENTIAL), (20, TANGENTIAL)];
        let rate = [(21, RADIAL_RATE), (19, TANGENTIAL_RATE), (19, TANGENTIAL_RATE)];
        let offset = offset.map(|(bits, unit)| self.number(bits, unit));
        let rate = rate.map(|(bits, unit)| self.number(bits, unit));
        let issue_mask = (1 << self.issue_bits) - 1;
        Some(Correction::Orbit(Orbit {
            issue,
            issue_mask,
            offset: known(offset)?,
            rate: known(rate)?,
        }))
    }

    fn clock(&mut self) -> Option<Correction> {
        let terms = [(22, CLOCK), (21, CLOCK_RATE), (27, CLOCK_AGEING)];
        let terms = terms.map(|(bits, unit)| self.number(bits, unit));
        known(terms).map(|terms| Correction::Clock(Clock(terms)))
    }

    fn code(&mut self) -> Option<Correction> {
        let number = self.bits.integer(5) as usize;
        let bias = self.number(14, CODE);
        let signal = match self.system {
            System::Gps => GPS_SIGNALS.get(number),
            System::Galileo => GALILEO_SIGNALS.get(number),
        };
        Some(Correction::Code { signal: **signal?, bias: bias? })
    }

    /// Whether there is another part of the message.
    const fn is_more(&self) -> bool {
        self.clock_follows || self.codes > 0 || self.satellites > 0
    }

    /// Reads the next part of the message; `None` for one without a known correction.
    fn part(&mut self) -> Option<Correction> {
        if self.clock_follows {
            self.clock_follows = false;
            return self.clock();
        }
        if self.codes > 0 {
            self.codes -= 1;
            return self.code();
        }
        self.satellites = self.satellites.saturating_sub(1);
        self.satellite = self.bits.integer(6) as u8;
        match self.content {
            Content::Orbits => self.orbit(),
            Content::Clocks => self.clock(),
            Content::Codes => {
                self.codes = self.bits.integer(5);
                None
            }
            Content::OrbitsAndClocks => {
                self.clock_follows = true;
                self.orbit()
            }
        }
    }
}

impl Iterator for Corrections<'_> {
    type Item = (u8, Correction);

    fn next(&mut self) -> Option<Self::Item> {
        while self.is_more() {
            let part = self.part();
            if self.bits.place() > self.end {
                return None;
            }
            if let Some(correction) = part {
                return Some((self.satellite, correction));
            }
        }
        None
    }
}

/// Three numbers, if all are known.
fn known([first, second, third]: [Option<f64>; 3]) -> Option<[f64; 3]> {
    Some([first?, second?, third?])
}
