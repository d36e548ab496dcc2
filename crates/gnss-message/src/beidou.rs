//! The navigation message D1 of BeiDou's satellites that are not geostationary, by its subframes (BDS-SIS-ICD-B1I 3.0, 5.2).

use core::array;
use core::f64::consts::PI;

use crate::bits::Packer;
use crate::{Bits, Ephemeris, Part, accuracy};

/// Words of a subframe.
pub const WORDS: usize = 10;
/// Bits of a word: all of it, what the first one holds besides 4 bits of parity, and what the others hold besides 8.
const WHOLE: u32 = 30;
const FIRST: u32 = 26;
const OTHER: u32 = 22;
const BYTES: usize = (FIRST as usize + (WORDS - 1) * OTHER as usize) / 8;
/// The preamble of each subframe.
const PREAMBLE: u64 = 0b111_0001_0010;
/// The subframe's number, behind the preamble and four reserved bits.
const NUMBER: usize = 15;
/// The second of the week in which the subframe began.
const SENT: usize = 18;
/// The first bit behind that.
const DATA: usize = 38;
/// From a subframe to the next, s, and the seconds of a week.
const LENGTH: u64 = 6;
const WEEK: u64 = 604_800;
/// Times are in units of 2³ s.
const TICK: i32 = 3;
/// Group delays are in units of 0.1 ns.
const DELAY: f64 = 1e-10;

/// A subframe: 224 bits, without their parity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Subframe([u8; BYTES]);

impl Subframe {
    /// A subframe from words of 30 bits, right aligned, whose last 4 (first word) or 8 bits are the parity, as UBX-RXM-SFRBX has
    /// them for B1I D1 and B2I D1. `None` without the preamble. The receiver must have checked the parity. Geostationary satellites
    /// send another message, D2, with the same preamble: the caller leaves them out.
    pub fn from_words(words: &[u32; WORDS]) -> Option<Self> {
        let pack = |packed: Packer<BYTES>, (index, word): (usize, &u32)| {
            let held = if index == 0 { FIRST } else { OTHER };
            packed.push(u64::from(word.wrapping_shr(WHOLE - held)), held)
        };
        let subframe = Self(words.iter().enumerate().fold(Packer::new(), pack).bytes());
        (subframe.bits(0).integer(11) == PREAMBLE).then_some(subframe)
    }

    /// The second of the week in which the subframe after this one begins.
    fn end(&self) -> u64 {
        (self.bits(SENT).integer(20) + LENGTH) % WEEK
    }

    const fn bits(&self, place: usize) -> Bits<'_> {
        Bits::at(&self.0, place)
    }
}

impl Part<3> for Subframe {
    fn number(&self) -> u8 {
        self.bits(NUMBER).integer(3) as u8
    }

    fn ephemeris([first, second, third]: &[Self; 3]) -> Option<Ephemeris> {
        // Subframes 2 and 3 name no issue: all three must come from one frame.
        let begin = |it: &Self| it.bits(SENT).integer(20);
        if begin(second) != first.end() || begin(third) != second.end() {
            return None;
        }
        let mut bits = first.bits(DATA);
        let is_healthy = bits.integer(1) == 0;
        // The age of the clock's data.
        bits.skip(5);
        let accuracy = accuracy::ura(bits.integer(4) as u8);
        // The week.
        bits.skip(13);
        let clock_second = bits.unsigned(17, TICK);
        let group_delays = array::from_fn(|_| DELAY * bits.signed(10, 0));
        // The ionosphere.
        bits.skip(64);
        let [ageing, offset, drift] =
            [(11, -66), (24, -33), (22, -50)].map(|(width, power)| bits.signed(width, power));
        let issue = bits.integer(5);

        let mut bits = second.bits(DATA);
        let mean_motion_correction = PI * bits.signed(16, -43);
        let cosine_latitude = bits.signed(18, -31);
        let mean_anomaly = PI * bits.signed(32, -31);
        let eccentricity = bits.unsigned(32, -33);
        let sine_latitude = bits.signed(18, -31);
        let radius_terms = array::from_fn(|_| bits.signed(18, -6));
        let root_of_axis = bits.unsigned(32, -19);
        let early = bits.integer(2);

        let mut bits = third.bits(DATA);
        let late = bits.integer(15);
        let inclination = PI * bits.signed(32, -31);
        let cosine_inclination = bits.signed(18, -31);
        let node_rate = PI * bits.signed(24, -43);
        let sine_inclination = bits.signed(18, -31);
        let inclination_rate = PI * bits.signed(14, -43);
        let [node, perigee]: [f64; 2] = array::from_fn(|_| PI * bits.signed(32, -31));

        // Orbit and clock refer to the same time.
        let time = 8.0 * (early << 15 | late) as f64;
        if time != clock_second {
            return None;
        }
        Some(Ephemeris {
            second: time,
            clock_second,
            clock: [offset, drift, ageing],
            issue: issue as u16,
            root_of_axis,
            eccentricity,
            mean_anomaly,
            mean_motion_correction,
            perigee,
            node,
            node_rate,
            inclination,
            inclination_rate,
            latitude_terms: [cosine_latitude, sine_latitude],
            radius_terms,
            inclination_terms: [cosine_inclination, sine_inclination],
            group_delays,
            accuracy,
            is_healthy,
        })
    }
}
