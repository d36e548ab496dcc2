//! The navigation message I/NAV of Galileo, by its words (OS SIS ICD 2.1, 4.3).

use core::array;
use core::f64::consts::PI;

use crate::bits::Packer;
use crate::{Bits, Ephemeris, Part, accuracy, crc_24q};

/// Words of 32 bits in which a receiver passes a page on: the first half its even part, the second half its odd one.
pub const WORDS: usize = 8;
/// Bytes of each part.
const PART: usize = 4 * WORDS / 2;
/// Data bits of each part, behind two that tell which part it is and whether the page is an alert.
const EVEN: usize = 112;
const ODD: usize = 16;
const FRONT: usize = 2;
/// Bits of the odd part before the checksum, which covers them and all the even part but its tail.
const SUMMED: usize = 82;
/// Four zeros in front make the summed bits whole bytes.
const PADDING: usize = 4;
/// Bits of the type of a word, and of the number of its issue.
const TYPE: usize = 6;
const ISSUE: usize = 10;
/// A minute, in which times are told (s).
const MINUTE: f64 = 60.0;

/// A word of the message: 128 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Word([u8; (EVEN + ODD) / 8]);

impl Word {
    /// From both parts of a page, as UBX-RXM-SFRBX has them of E1-B and of E5b-I. `None` for an alert, a page with a wrong
    /// checksum and a page of another message.
    pub fn from_page(page: &[u32; WORDS]) -> Option<Self> {
        let mut bytes = [0; 2 * PART];
        for (bytes, word) in bytes.chunks_exact_mut(4).zip(page) {
            bytes.copy_from_slice(&word.to_be_bytes());
        }
        let (even, odd) = bytes.split_at_checked(PART)?;
        let begin = |part| Bits::at(part, 0).integer(FRONT);
        if begin(even) != 0 || begin(odd) != 2 {
            return None;
        }
        let summed = Packer::<{ (PADDING + FRONT + EVEN + SUMMED) / 8 }>::new()
            .push(0, PADDING as u32)
            .copy(Bits::at(even, 0), FRONT + EVEN)
            .copy(Bits::at(odd, 0), SUMMED);
        if u64::from(crc_24q(&summed.bytes())) != Bits::at(odd, SUMMED).integer(24) {
            return None;
        }
        let word = Packer::new().copy(Bits::at(even, FRONT), EVEN);
        Some(Self(word.copy(Bits::at(odd, FRONT), ODD).bytes()))
    }

    const fn bits(&self) -> Bits<'_> {
        Bits::at(&self.0, TYPE)
    }
}

impl Part<5> for Word {
    fn number(&self) -> u8 {
        Bits::at(&self.0, 0).integer(TYPE) as u8
    }

    fn ephemeris(words: &[Self; 5]) -> Option<Ephemeris> {
        let [mut first, mut second, mut third, mut fourth, mut fifth] =
            words.each_ref().map(Self::bits);
        let issue = first.integer(ISSUE);
        if [&mut second, &mut third, &mut fourth].into_iter().any(|it| it.integer(ISSUE) != issue) {
            return None;
        }
        let time = MINUTE * first.unsigned(14, 0);
        let mean_anomaly = PI * first.signed(32, -31);
        let eccentricity = first.unsigned(32, -33);
        let root_of_axis = first.unsigned(32, -19);

        let [node, inclination, perigee]: [f64; 3] =
            array::from_fn(|_| PI * second.signed(32, -31));
        let inclination_rate = PI * second.signed(14, -43);

        let node_rate = PI * third.signed(24, -43);
        let mean_motion_correction = PI * third.signed(16, -43);
        let latitude_terms = array::from_fn(|_| third.signed(16, -29));
        let radius_terms = array::from_fn(|_| third.signed(16, -5));
        let accuracy = accuracy::sisa(third.integer(8) as u8);

        // The satellite's number.
        fourth.skip(6);
        let inclination_terms = array::from_fn(|_| fourth.signed(16, -29));
        let clock_second = MINUTE * fourth.unsigned(14, 0);
        let clock =
            [(31, -34), (21, -46), (6, -59)].map(|(width, power)| fourth.signed(width, power));

        // The ionosphere, of another model than Klobuchar's.
        fifth.skip(11 + 11 + 14 + 5);
        let group_delays = array::from_fn(|_| fifth.signed(10, -32));
        // Health and validity of both signals.
        let is_healthy = fifth.integer(2 + 2 + 1 + 1) == 0;
        Some(Ephemeris {
            second: time,
            clock_second,
            clock,
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
            latitude_terms,
            radius_terms,
            inclination_terms,
            group_delays,
            accuracy,
            is_healthy,
        })
    }
}
