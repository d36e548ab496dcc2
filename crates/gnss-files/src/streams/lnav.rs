//! The legacy message of GPS from its subframes (IS-GPS-200, 20.3.3).

use super::bits::Fields;
use super::indices::{SEMICIRCLE, ura};
use crate::navigation::{Ephemeris, time_of_week};
use crate::time::GpsTime;

/// Words of a subframe, and bytes of a word without its parity.
pub(super) const WORDS: usize = 10;
const BYTES: usize = 3;
/// The first bit behind the telemetry and the hand-over word.
const DATA: usize = 48;
/// The page of the fourth subframe that has the ionosphere.
const IONOSPHERE: u64 = 56;
/// 16 s: what times are told in.
const TICK: f64 = 16.0;

/// A subframe: words of 24 bits, the parity taken off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Subframe([u8; WORDS * BYTES]);

impl Subframe {
    /// From words with 6 bits of parity at their ends, as receivers pass them on; none of another number of words.
    pub(super) fn of(words: impl Iterator<Item = u32>) -> Option<Self> {
        // The highest two bits say nothing.
        let bytes = words.map(|word| (word << 2).to_be_bytes()).flat_map(|[a, b, c, _]| [a, b, c]);
        bytes.collect::<Vec<_>>().try_into().ok().map(Self)
    }

    /// Its number, from 1 to 5.
    pub(super) fn number(&self) -> u64 {
        self.fields(43).whole(3)
    }

    fn fields(&self, place: usize) -> Fields<'_> {
        Fields::at(&self.0, place)
    }
}

/// α and β of Klobuchar's model, if a subframe has them.
pub(super) fn ionosphere(subframe: &Subframe) -> Option<[[f64; 4]; 2]> {
    if subframe.number() != 4 || subframe.fields(DATA + 2).whole(6) != IONOSPHERE {
        return None;
    }
    let mut fields = subframe.fields(DATA + 8);
    let alpha = [-30, -27, -24, -24].map(|power| fields.signed(8, power));
    Some([alpha, [11, 14, 16, 16].map(|power| fields.signed(8, power))])
}

/// The ephemeris of the first three subframes, of a week `near` a time, if they are of one issue.
pub(super) fn ephemeris([first, second, third]: [Subframe; 3], near: GpsTime) -> Option<Ephemeris> {
    let mut fields = first.fields(DATA + 12);
    let accuracy = ura(fields.whole(4) as u8);
    let is_healthy = fields.whole(6) == 0;
    fields.skip(2 + 1 + 87);
    let group_delay = fields.signed(8, -31);
    let issue_of_clock = fields.whole(8);
    let clock_second = TICK * fields.unsigned(16, 0);
    let [ageing, drift, offset] =
        [(8, -55), (16, -43), (22, -31)].map(|(bits, power)| fields.signed(bits, power));

    let mut fields = second.fields(DATA);
    let issue = fields.whole(8);
    let sine_radius = fields.signed(16, -5);
    let mean_motion_correction = SEMICIRCLE * fields.signed(16, -43);
    let mean_anomaly = SEMICIRCLE * fields.signed(32, -31);
    let cosine_latitude = fields.signed(16, -29);
    let eccentricity = fields.unsigned(32, -33);
    let sine_latitude = fields.signed(16, -29);
    let root_of_axis = fields.unsigned(32, -19);
    let second_of_week = TICK * fields.unsigned(16, 0);

    let mut fields = third.fields(DATA);
    let cosine_inclination = fields.signed(16, -29);
    let node = SEMICIRCLE * fields.signed(32, -31);
    let sine_inclination = fields.signed(16, -29);
    let inclination = SEMICIRCLE * fields.signed(32, -31);
    let cosine_radius = fields.signed(16, -5);
    let perigee = SEMICIRCLE * fields.signed(32, -31);
    let node_rate = SEMICIRCLE * fields.signed(24, -43);
    let issue_again = fields.whole(8);
    let inclination_rate = SEMICIRCLE * fields.signed(14, -43);
    if issue != issue_again || issue != issue_of_clock {
        return None;
    }
    let time = time_of_week(near, second_of_week);
    Some(Ephemeris {
        time,
        clock_time: time_of_week(time, clock_second),
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
        ..Ephemeris::NOTHING
    })
}
