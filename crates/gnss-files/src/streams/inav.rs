//! The message I/NAV of Galileo from its words (OS SIS ICD 2.1, 4.3).

use std::array;

use super::bits::Fields;
use super::frames::crc_24q;
use super::indices::{SEMICIRCLE, sisa};
use crate::navigation::{Ephemeris, Message, time_of_week};
use crate::time::GpsTime;

/// Words of 32 bits in which a receiver passes a page on: the first half its even part, the second half its odd one.
pub(super) const WORDS: usize = 8;
/// Bits of a word of the message in each part, behind two that tell which part it is and whether the page is an alert.
const EVEN: usize = 112;
const ODD: usize = 16;
const FRONT: usize = 2;
/// Bits of the odd part before the checksum, which is of them and of all the even part but its tail.
const SUMMED: usize = 82;
/// Four zeros make the summed bits whole bytes.
const PADDING: usize = 4;
/// A minute: what times are told in, s.
const TICK: f64 = 60.0;
/// Of the type of a word and the number of its issue.
const TYPE: usize = 6;
const ISSUE: usize = 10;

/// A word of the message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Word([u8; 16]);

impl Word {
    /// From both parts of a page; none of an alert, of a damaged page and of another message.
    pub(super) fn of(words: impl Iterator<Item = u32>) -> Option<Self> {
        let page: Vec<u8> = words.flat_map(u32::to_be_bytes).collect();
        let (even, odd) = page.split_at_checked(4 * WORDS / 2)?;
        let front = |part, bits| Fields::at(part, 0).whole(bits);
        let is_page = odd.len() == even.len() && front(even, FRONT) == 0 && front(odd, FRONT) == 2;
        let bits =
            |part, from, count| (from..from + count).map(move |it| Fields::at(part, it).whole(1));
        let summed =
            bits(&[0], 0, PADDING).chain(bits(even, 0, FRONT + EVEN)).chain(bits(odd, 0, SUMMED));
        let is_whole = || u64::from(crc_24q(&packed(summed))) == Fields::at(odd, SUMMED).whole(24);
        if !is_page || !is_whole() {
            return None;
        }
        packed(bits(even, FRONT, EVEN).chain(bits(odd, FRONT, ODD))).try_into().ok().map(Self)
    }

    pub(super) fn number(&self) -> u64 {
        Fields::at(&self.0, 0).whole(TYPE)
    }

    fn fields(&self) -> Fields<'_> {
        Fields::at(&self.0, TYPE)
    }
}

/// Bits in bytes.
fn packed(bits: impl Iterator<Item = u64>) -> Vec<u8> {
    let bits: Vec<_> = bits.collect();
    bits.chunks(8).map(|byte| byte.iter().fold(0, |byte, bit| byte << 1 | *bit as u8)).collect()
}

/// The ephemeris of words 1 to 5, of a week `near` a time, if those that tell an issue are of the same.
pub(super) fn ephemeris(words: [Word; 5], near: GpsTime) -> Option<Ephemeris> {
    let [mut first, mut second, mut third, mut fourth, mut fifth] =
        words.each_ref().map(Word::fields);
    let issue = first.whole(ISSUE);
    if [&mut second, &mut third, &mut fourth].into_iter().any(|it| it.whole(ISSUE) != issue) {
        return None;
    }
    let second_of_week = TICK * first.unsigned(14, 0);
    let mean_anomaly = SEMICIRCLE * first.signed(32, -31);
    let eccentricity = first.unsigned(32, -33);
    let root_of_axis = first.unsigned(32, -19);

    let [node, inclination, perigee]: [f64; 3] =
        array::from_fn(|_| SEMICIRCLE * second.signed(32, -31));
    let inclination_rate = SEMICIRCLE * second.signed(14, -43);

    let node_rate = SEMICIRCLE * third.signed(24, -43);
    let mean_motion_correction = SEMICIRCLE * third.signed(16, -43);
    let latitude_terms = array::from_fn(|_| third.signed(16, -29));
    let radius_terms = array::from_fn(|_| third.signed(16, -5));
    let accuracy = sisa(third.whole(8) as u8);

    // The satellite's number.
    fourth.skip(6);
    let inclination_terms = array::from_fn(|_| fourth.signed(16, -29));
    let clock_second = TICK * fourth.unsigned(14, 0);
    let clock = [(31, -34), (21, -46), (6, -59)].map(|(bits, power)| fourth.signed(bits, power));

    // The ionosphere of another model.
    fifth.skip(11 + 11 + 14 + 5);
    let group_delays = array::from_fn(|_| fifth.signed(10, -32));
    // Health and validity of both signals.
    let is_healthy = fifth.whole(2 + 2 + 1 + 1) == 0;

    let time = time_of_week(near, second_of_week);
    Some(Ephemeris {
        message: Message::Inav,
        time,
        clock_time: time_of_week(time, clock_second),
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
        ..Ephemeris::NOTHING
    })
}
