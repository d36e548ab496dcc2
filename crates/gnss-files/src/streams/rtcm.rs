//! RTCM 3: observations (MSM4 and MSM7 of GPS and Galileo) and ephemerides (1019, 1045, 1046).

mod ephemerides;

use rtcm_rs::prelude::*;

use self::ephemerides::{ROLLOVER, WEEK, fnav, gps, inav};
use super::{Locks, Signals, Stream};
use crate::biases::SPEED_OF_LIGHT;
use crate::error::Error;
use crate::fields::GALILEO;
use crate::navigation::{Ephemeris, Message as Of, time_of_week};
use crate::observations::{Raw, Signal};
use crate::text::Text;
use crate::time::GpsTime;

/// Half a week, ms: farther back time does not go.
const HALF_WEEK: i64 = 302_400_000;
/// The same in s.
const HALF_WEEK_S: f64 = 302_400.0;
/// Most cells of satellites and signals that a message of observations may have.
const MOST_CELLS: u32 = 64;

/// Reads a file.
///
/// # Errors
/// [`Error::File`] if it tells no date.
pub(super) fn read(text: &Text) -> Result<Stream, Error> {
    let mut reader = Reader::default();
    let bytes = text.bytes();
    let mut position = 0;
    while let Some(rest) = bytes.get(position..).filter(|rest| !rest.is_empty()) {
        match next_msg_frame(rest) {
            (used, Some(frame)) => {
                position += used;
                if is_regular(&frame) {
                    reader.take(&frame.get_message());
                } else {
                    reader.stream.skipped += 1;
                }
            }
            // What looks like the beginning of a frame that does not end may be none.
            (used, None) => position += used + 1,
        }
    }
    reader.finish(text)
}

/// Whether a message of observations has as many cells as may be: the decoder relies on that.
fn is_regular(frame: &MessageFrame<'_>) -> bool {
    let number = frame.message_number().unwrap_or_default();
    if !(1071..=1137).contains(&number) {
        return true;
    }
    // The masks of satellites and of signals stand behind the header of 73 bits.
    let ones = |from: usize, bits: usize| {
        let bit =
            |place: usize| frame.data().get(place / 8).map(|byte| byte >> (7 - place % 8) & 1);
        (from..from + bits).filter_map(bit).map(u32::from).sum::<u32>()
    };
    (1..=MOST_CELLS).contains(&(ones(73, 64) * ones(137, 32)))
}

/// An epoch of which the week is not known yet: ms of the week, and its satellites.
type Epoch = (i64, Vec<Signals>);

#[derive(Debug, Default)]
struct Reader {
    stream: Stream,
    epochs: Vec<Epoch>,
    locks: Locks,
    /// Ephemerides of the weeks that were transmitted, each with the number of its satellite and the place of the epoch before it.
    ephemerides: Vec<(usize, u8, Ephemeris)>,
}

/// The signals of a message of observations: satellites' rough ranges, and what is fine beside them, ms.
macro_rules! cells {
    ($reader:ident, $message:ident, $time:ident, $system:literal, $code:ident, $phase:ident, $lock:ident, $tracked:ident) => {{
        let data = &$message.data_segment;
        let rough = |satellite: u8| {
            let of = data.satellite_data.iter().find(|it| it.satellite_id == satellite)?;
            let whole = f64::from(of.gnss_satellite_rough_range_integer_ms?);
            Some(whole + of.gnss_satellite_rough_range_mod1ms_ms)
        };
        for cell in data.signal_data.iter() {
            let name = [b'0' + cell.signal_id.band(), cell.signal_id.attribute() as u8];
            let fine = [cell.$code, cell.$phase.filter(|_| cell.half_cycle_ambiguity_ind == 0)];
            let lock = $tracked(cell.$lock);
            $reader.cell(
                i64::from($message.$time),
                ($system, cell.satellite_id),
                name,
                (rough(cell.satellite_id), fine, lock),
            );
        }
    }};
}

impl Reader {
    fn take(&mut self, message: &Message) {
        match message {
            Message::Msg1074(it) => cells!(
                self,
                it,
                gps_epoch_time_ms,
                b'G',
                gnss_signal_fine_pseudorange_ms,
                gnss_signal_fine_phaserange_ms,
                gnss_phaserange_lock_time_ind,
                tracked_short
            ),
            Message::Msg1077(it) => cells!(
                self,
                it,
                gps_epoch_time_ms,
                b'G',
                gnss_signal_fine_pseudorange_ext_ms,
                gnss_signal_fine_phaserange_ext_ms,
                gnss_phaserange_lock_time_ext_ind,
                tracked_long
            ),
            Message::Msg1094(it) => cells!(
                self,
                it,
                gal_epoch_time_ms,
                b'E',
                gnss_signal_fine_pseudorange_ms,
                gnss_signal_fine_phaserange_ms,
                gnss_phaserange_lock_time_ind,
                tracked_short
            ),
            Message::Msg1097(it) => cells!(
                self,
                it,
                gal_epoch_time_ms,
                b'E',
                gnss_signal_fine_pseudorange_ext_ms,
                gnss_signal_fine_phaserange_ext_ms,
                gnss_phaserange_lock_time_ext_ind,
                tracked_long
            ),
            Message::Msg1019(it) => self.ephemeris(it.gps_satellite_id, gps(it)),
            Message::Msg1045(it) => self.ephemeris(GALILEO + it.gal_satellite_id, fnav(it)),
            Message::Msg1046(it) => self.ephemeris(GALILEO + it.gal_satellite_id, inav(it)),
            _ => self.stream.skipped += 1,
        }
    }

    /// Takes in a signal of a satellite: a rough range, a fine code and a fine phase, ms, and for how many ms that
    /// has been tracked at least.
    fn cell(
        &mut self,
        time: i64,
        (system, number): (u8, u8),
        [band, tracking]: [u8; 2],
        (rough, [code, phase], lock): (Option<f64>, [Option<f64>; 2], u32),
    ) {
        let satellite = if system == b'E' { GALILEO.saturating_add(number) } else { number };
        let signal = |kind| Signal::new(system, &[kind, band, tracking]);
        let (Some(rough), Some(of_code), Some(of_phase)) = (rough, signal(b'C'), signal(b'L'))
        else {
            return;
        };
        if self.epochs.last().is_none_or(|(last, _)| *last != time) {
            self.epochs.push((time, Vec::new()));
        }
        let Some((_, satellites)) = self.epochs.last_mut() else { return };
        if satellites.last().is_none_or(|(last, _)| *last != satellite) {
            satellites.push((satellite, Vec::new()));
        }
        let Some((_, raw)) = satellites.last_mut() else { return };
        let milliseconds = |fine: f64| 1e-3 * (rough + fine);
        if let Some(code) = code {
            let value = SPEED_OF_LIGHT * milliseconds(code);
            raw.push(Raw { signal: of_code, value, lock_lost: false });
        }
        if let Some(phase) = phase {
            let lock_lost = self.locks.lost(satellite, of_phase, time, lock);
            let value = of_phase.frequency() * milliseconds(phase);
            raw.push(Raw { signal: of_phase, value, lock_lost });
        }
    }

    fn ephemeris(&mut self, satellite: u8, ephemeris: Ephemeris) {
        self.ephemerides.push((self.epochs.len().saturating_sub(1), satellite, ephemeris));
    }

    /// Gives epochs and ephemerides their weeks.
    fn finish(self, text: &Text) -> Result<Stream, Error> {
        let Self { mut stream, epochs, ephemerides, .. } = self;
        let seconds: Vec<_> = epochs.iter().map(|(time, _)| 1e-3 * *time as f64).collect();
        // Weeks of Galileo are told without a doubt.
        let near =
            dated(&ephemerides, &seconds, true).or_else(|| dated(&ephemerides, &seconds, false));
        let Some((place, near)) = near else {
            let problem = "expected a message that tells the week (1019, 1045 or 1046), found none";
            return if epochs.is_empty() { Ok(stream) } else { Err(text.error(problem)) };
        };
        let elapsed = elapsed(&epochs);
        let since_first = elapsed.get(place).copied().unwrap_or_default();
        let first = GpsTime::new(near.day(), near.second() - 1e-3 * since_first as f64);
        let mut last: Option<(GpsTime, i64)> = None;
        for ((_, satellites), elapsed) in epochs.into_iter().zip(elapsed) {
            let time = match last {
                None => time_of_week(first, seconds.first().copied().unwrap_or_default()),
                Some((before, last)) => {
                    GpsTime::new(before.day(), before.second() + 1e-3 * (elapsed - last) as f64)
                }
            };
            last = Some((time, elapsed));
            stream.epochs.push((time, satellites));
        }
        for (place, satellite, mut ephemeris) in ephemerides {
            let time = rolled_to(ephemeris.time, near);
            let epoch = stream.epochs.get(place).map_or(time, |(epoch, _)| *epoch);
            let time = in_week_of(time, epoch);
            ephemeris.clock_time = time_of_week(time, second_of_week(ephemeris.clock_time));
            ephemeris.time = time;
            stream.ephemerides.push((satellite, ephemeris));
        }
        Ok(stream)
    }
}

/// The place of an epoch, and an instant near it, by the ephemerides of Galileo or of GPS; `seconds` are those of the epochs in
/// their weeks. Some senders tell the week of the transmission, as satellites do, others that of the ephemeris: those are
/// preferred of which both are the same.
fn dated(
    ephemerides: &[(usize, u8, Ephemeris)],
    seconds: &[f64],
    of_galileo: bool,
) -> Option<(usize, GpsTime)> {
    let of_system = || ephemerides.iter().filter(|(.., it)| (it.message != Of::Lnav) == of_galileo);
    let second = |place: usize| seconds.get(place).copied();
    let is_plain = |(place, _, it): &&(usize, u8, Ephemeris)| {
        second(*place).is_none_or(|second| (second - second_of_week(it.time)).abs() < HALF_WEEK_S)
    };
    let (place, _, told) = of_system().find(is_plain).or_else(|| of_system().next())?;
    let away = second(*place).map_or(0.0, |second| second - second_of_week(told.time));
    Some((*place, GpsTime::new(told.time.day(), told.time.second() + away)))
}

/// ms from the first epoch to each.
fn elapsed(epochs: &[Epoch]) -> Vec<i64> {
    let mut before = epochs.first().map_or(0, |(time, _)| *time);
    let mut elapsed = 0;
    let steps = epochs.iter().map(|(time, _)| {
        let step = *time - before;
        before = *time;
        elapsed += if step < -HALF_WEEK { step + 2 * HALF_WEEK } else { step };
        elapsed
    });
    steps.collect()
}

/// The time of an ephemeris in the week in which it is within half a week of an epoch: the week told is at most one off.
fn in_week_of(time: GpsTime, epoch: GpsTime) -> GpsTime {
    let away = (epoch.since(time) / (2.0 * HALF_WEEK_S)).round().clamp(-1.0, 1.0);
    GpsTime::new(time.day() + WEEK * away as i32, time.second())
}

/// For how many ms at least a phase has been tracked, by the indicator of MSM4 (DF402) …
const fn tracked_short(indicator: u8) -> u32 {
    match indicator {
        0 => 0,
        1..=14 => 1 << (indicator + 4),
        _ => Locks::LONGEST,
    }
}

/// … and by that of MSM7 (DF407), whose steps double after every 32.
const fn tracked_long(indicator: u16) -> u32 {
    let step = indicator / 32;
    match indicator {
        0..64 => indicator as u32,
        64..704 => (32 + (indicator % 32) as u32) << (step - 1),
        _ => Locks::LONGEST,
    }
}

/// Seconds since a week of GPS began.
fn second_of_week(time: GpsTime) -> f64 {
    f64::from((time.day() - GpsTime::EPOCH.day()).rem_euclid(WEEK)) * 86_400.0 + time.second()
}

/// The same time in the 1024 weeks that are nearest to another one.
fn rolled_to(time: GpsTime, near: GpsTime) -> GpsTime {
    let away = f64::from(near.day() - time.day()) / f64::from(WEEK * ROLLOVER);
    GpsTime::new(time.day() + away.round() as i32 * WEEK * ROLLOVER, time.second())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indicators_of_lock_times() {
        let short = [0, 1, 2, 14, 15].map(tracked_short);
        assert_eq!(short, [0, 32, 64, 262_144, Locks::LONGEST]);
        // The first of some rows of the table, and the last before it.
        let long = [0, 63, 64, 95, 96, 160, 672, 703, 704].map(tracked_long);
        let table = [0, 63, 64, 126, 128, 512, 33_554_432, 66_060_288, Locks::LONGEST];
        assert_eq!(long, table);
    }
}
