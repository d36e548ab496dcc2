//! The legacy navigation message of GPS, LNAV, by its subframes (IS-GPS-200, 20.3.3).

use core::f64::consts::PI;

use crate::bits::Packer;
use crate::{Bits, Ephemeris, Part, accuracy};

/// Words of a subframe.
pub const WORDS: usize = 10;
/// Bits of a word without its parity, and those of its parity.
const DATA_BITS: u32 = 24;
const PARITY: u32 = 6;
/// The preamble of each subframe.
const PREAMBLE: u64 = 0x8b;
/// The bit of the alert flag: ranges may be worse than the accuracy says.
const ALERT: usize = 41;
/// The subframe's number, within the hand-over word.
const NUMBER: usize = 43;
/// The first bit behind the telemetry and the hand-over word.
const DATA: usize = 48;
/// The page of the fourth subframe that has the ionosphere.
const IONOSPHERE: u64 = 56;
/// Times are in units of 2⁴ s.
const TICK: i32 = 4;

/// A subframe: words of 24 bits, without their parity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Subframe([u8; WORDS * DATA_BITS as usize / 8]);

impl Subframe {
    /// A subframe from words of 30 bits, right aligned, whose last 6 bits are the parity, as UBX-RXM-SFRBX has them for L1 C/A.
    /// `None` without the preamble of LNAV. The receiver must have checked the parity and restored inverted words.
    pub fn from_words(words: &[u32; WORDS]) -> Option<Self> {
        // The highest two bits are unused.
        let pack =
            |packed: Packer<_>, word: &u32| packed.push(u64::from(word >> PARITY), DATA_BITS);
        let subframe = Self(words.iter().fold(Packer::new(), pack).bytes());
        (subframe.bits(0).integer(8) == PREAMBLE).then_some(subframe)
    }

    /// α and β of Klobuchar's ionosphere model (s, s per semicircle, …), if this is the page that has them.
    pub fn ionosphere(&self) -> Option<[[f64; 4]; 2]> {
        if self.number() != 4 || self.bits(DATA + 2).integer(6) != IONOSPHERE {
            return None;
        }
        let mut bits = self.bits(DATA + 8);
        let alpha = [-30, -27, -24, -24].map(|power| bits.signed(8, power));
        Some([alpha, [11, 14, 16, 16].map(|power| bits.signed(8, power))])
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
        let mut bits = first.bits(DATA + 12);
        let accuracy = accuracy::ura(bits.integer(4) as u8);
        let is_healthy = bits.integer(6) == 0 && first.bits(ALERT).integer(1) == 0;
        bits.skip(2 + 1 + 87);
        let group_delay = bits.signed(8, -31);
        let issue_of_clock = bits.integer(8);
        let clock_second = bits.unsigned(16, TICK);
        let [ageing, drift, offset] =
            [(8, -55), (16, -43), (22, -31)].map(|(width, power)| bits.signed(width, power));

        let mut bits = second.bits(DATA);
        let issue = bits.integer(8);
        let sine_radius = bits.signed(16, -5);
        let mean_motion_correction = PI * bits.signed(16, -43);
        let mean_anomaly = PI * bits.signed(32, -31);
        let cosine_latitude = bits.signed(16, -29);
        let eccentricity = bits.unsigned(32, -33);
        let sine_latitude = bits.signed(16, -29);
        let root_of_axis = bits.unsigned(32, -19);
        let time = bits.unsigned(16, TICK);

        let mut bits = third.bits(DATA);
        let cosine_inclination = bits.signed(16, -29);
        let node = PI * bits.signed(32, -31);
        let sine_inclination = bits.signed(16, -29);
        let inclination = PI * bits.signed(32, -31);
        let cosine_radius = bits.signed(16, -5);
        let perigee = PI * bits.signed(32, -31);
        let node_rate = PI * bits.signed(24, -43);
        let issue_again = bits.integer(8);
        let inclination_rate = PI * bits.signed(14, -43);
        if issue != issue_again || issue != issue_of_clock {
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
            radius_terms: [cosine_radius, sine_radius],
            inclination_terms: [cosine_inclination, sine_inclination],
            group_delays: [group_delay, 0.0],
            accuracy,
            is_healthy,
        })
    }
}
