//! RTCM 3: observations (MSM4 and MSM7), ephemerides (1019, 1042, 1045, 1046), and corrections of ephemerides (SSR: 1057 to 1060,
//! 1240 to 1243, 4076).

mod ephemerides;
mod glonass;
mod lock_times;
mod passed_over;
mod weeks;

use kestirim_gnss_message::ssr;
use rtcm_rs::prelude::*;

use self::ephemerides::{beidou, fnav, gps, inav};
use self::glonass::OfGlonass;
use self::lock_times::{tracked_long, tracked_short};
use self::passed_over::{PassedOver, cell_count};
use self::weeks::{dated, elapsed, in_week_of, rolled_to, second_of_week};
use super::{Locks, Signals, Stream, WEEK_MS};
use crate::biases::SPEED_OF_LIGHT;
use crate::error::Error;
use crate::navigation::{Ephemeris, time_of_week};
use crate::observations::{Raw, Signal};
use crate::ssr::SsrCorrection;
use crate::system::System;
use crate::text::Text;
use crate::time::GpsTime;

/// The maximum number of satellite and signal cells in an observation message.
const MOST_CELLS: u32 = 64;

/// Reads a file.
///
/// # Errors
/// [`Error::File`] if it holds observations but no message that tells the week.
pub(super) fn read(text: &Text) -> Result<Stream, Error> {
    let mut reader = Reader::default();
    let bytes = text.bytes();
    let mut position = 0;
    while let Some(rest) = bytes.get(position..).filter(|rest| !rest.is_empty()) {
        match next_msg_frame(rest) {
            (used, Some(frame)) => {
                position += used;
                // The decoder relies on this limit.
                if cell_count(&frame).is_none_or(|count| (1..=MOST_CELLS).contains(&count)) {
                    reader.take(&frame);
                } else {
                    reader.stream.skipped += 1;
                }
            }
            // An apparent beginning of a frame that does not end may be no frame.
            (used, None) => position += used + 1,
        }
    }
    reader.finish(text)
}

/// An epoch whose week is not known yet: ms of the week, and its satellites.
type Epoch = (i64, Vec<Signals>);

#[derive(Debug, Default)]
struct Reader {
    stream: Stream,
    epochs: Vec<Epoch>,
    locks: Locks,
    /// Ephemerides in the weeks that were transmitted, each with the index of the epoch before it and its satellite's
    /// number.
    ephemerides: Vec<(usize, u8, Ephemeris)>,
    glonass: OfGlonass,
    passed_over: PassedOver,
}

/// Reads the signals of an observation message: rough ranges of satellites, and fine ranges relative to them, ms.
macro_rules! cells {
    ($reader:ident, $message:ident, $time:expr, $system:expr, $code:ident, $phase:ident, $lock:ident, $tracked:ident) => {{
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
            let satellite = ($system, cell.satellite_id);
            $reader.cell($time, satellite, name, (rough(cell.satellite_id), fine, lock));
        }
    }};
}

/// Reads the signals of an MSM4 message.
macro_rules! short_cells {
    ($reader:ident, $message:ident, $time:expr, $system:expr) => {
        cells!(
            $reader,
            $message,
            $time,
            $system,
            gnss_signal_fine_pseudorange_ms,
            gnss_signal_fine_phaserange_ms,
            gnss_phaserange_lock_time_ind,
            tracked_short
        )
    };
}

/// Reads the signals of an MSM7 message.
macro_rules! long_cells {
    ($reader:ident, $message:ident, $time:expr, $system:expr) => {
        cells!(
            $reader,
            $message,
            $time,
            $system,
            gnss_signal_fine_pseudorange_ext_ms,
            gnss_signal_fine_phaserange_ext_ms,
            gnss_phaserange_lock_time_ext_ind,
            tracked_long
        )
    };
}

impl Reader {
    fn take(&mut self, frame: &MessageFrame<'_>) {
        // The decoder of the other messages knows neither those of Galileo nor those of the IGS.
        if let Some(message) = ssr::Message::from_data(frame.data()) {
            return self.stream.corrections.extend(SsrCorrection::of(message));
        }
        let behind = (1e3 * GpsTime::BEIDOU_BEHIND) as i64;
        let of_beidou = |time: u32| (i64::from(time) + behind).rem_euclid(WEEK_MS);
        match &frame.get_message() {
            Message::Msg1074(it) => {
                short_cells!(self, it, i64::from(it.gps_epoch_time_ms), System::Gps);
            }
            Message::Msg1077(it) => {
                long_cells!(self, it, i64::from(it.gps_epoch_time_ms), System::Gps);
            }
            Message::Msg1094(it) => {
                short_cells!(self, it, i64::from(it.gal_epoch_time_ms), System::Galileo);
            }
            Message::Msg1097(it) => {
                long_cells!(self, it, i64::from(it.gal_epoch_time_ms), System::Galileo);
            }
            Message::Msg1124(it) => {
                short_cells!(self, it, of_beidou(it.bds_epoch_time_ms), System::BeiDou);
            }
            Message::Msg1127(it) => {
                long_cells!(self, it, of_beidou(it.bds_epoch_time_ms), System::BeiDou);
            }
            Message::Msg1084(it) => {
                match OfGlonass::time(it.glo_day_of_week, it.glo_epoch_time_ms) {
                    Some(time) => short_cells!(self, it, time, System::Glonass),
                    None => self.stream.skipped += 1,
                }
            }
            Message::Msg1087(it) => {
                for of in it.data_segment.satellite_data.iter() {
                    let channel = of.glonass_satellite_frequency_channel_number;
                    self.glonass.on(of.satellite_id, channel);
                }
                match OfGlonass::time(it.glo_day_of_week, it.glo_epoch_time_ms) {
                    Some(time) => long_cells!(self, it, time, System::Glonass),
                    None => self.stream.skipped += 1,
                }
            }
            Message::Msg1042(it) => {
                let satellite = System::BeiDou.number(it.bds_satellite_id);
                if satellite.is_some_and(System::is_geostationary) {
                    self.stream.skipped += 1;
                    self.passed_over.ephemerides.note(b'C', it.bds_satellite_id);
                } else {
                    self.ephemeris(satellite, beidou(it));
                }
            }
            Message::Msg1019(it) => self.ephemeris(Some(it.gps_satellite_id), gps(it)),
            Message::Msg1045(it) => {
                self.ephemeris(System::Galileo.number(it.gal_satellite_id), fnav(it));
            }
            Message::Msg1046(it) => {
                self.ephemeris(System::Galileo.number(it.gal_satellite_id), inav(it));
            }
            other => {
                if let Message::Msg1020(it) = other {
                    let channel = it.glo_satellite_freq_chan_number;
                    self.glonass.on(it.glo_satellite_id, Some(channel));
                }
                self.stream.skipped += 1;
                self.passed_over.note(frame);
            }
        }
    }

    /// Adds a signal of a satellite: a rough range, a fine code and a fine phase, ms, and for how many ms the phase has
    /// been tracked at least.
    fn cell(
        &mut self,
        time: i64,
        (system, number): (System, u8),
        [band, tracking]: [u8; 2],
        (rough, fine, lock): (Option<f64>, [Option<f64>; 2], u32),
    ) {
        let signal = |kind| Signal::new(system.letter(), &[kind, band, tracking]);
        let (Some(satellite), Some(rough)) = (system.number(number), rough) else { return };
        let (Some(of_code), Some(of_phase)) = (signal(b'C'), signal(b'L')) else { return };
        let [code, phase] = fine.map(|fine| fine.map(|fine| rough + fine));
        if system == System::Glonass {
            let both = [(of_code, code), (of_phase, phase)];
            let locks = (&mut self.locks, lock);
            return self.glonass.take((self.epochs.len(), time), number, both, locks);
        }
        if self.epochs.last().is_none_or(|(last, _)| *last != time) {
            self.epochs.push((time, Vec::new()));
        }
        let Some((_, satellites)) = self.epochs.last_mut() else { return };
        if satellites.last().is_none_or(|(last, _)| *last != satellite) {
            satellites.push((satellite, Vec::new()));
        }
        let Some((_, raw)) = satellites.last_mut() else { return };
        if let Some(code) = code {
            let value = SPEED_OF_LIGHT * 1e-3 * code;
            raw.push(Raw { signal: of_code, value, lock_lost: false });
        }
        if let Some(phase) = phase {
            let lock_lost = self.locks.lost(satellite, of_phase, time, lock);
            let value = of_phase.frequency(system) * 1e-3 * phase;
            raw.push(Raw { signal: of_phase, value, lock_lost });
        }
    }

    fn ephemeris(&mut self, satellite: Option<u8>, ephemeris: Ephemeris) {
        let Some(satellite) = satellite else { return };
        self.ephemerides.push((self.epochs.len().saturating_sub(1), satellite, ephemeris));
    }

    /// Assigns weeks to epochs and ephemerides.
    fn finish(self, text: &Text) -> Result<Stream, Error> {
        let Self { mut stream, mut epochs, ephemerides, glonass, passed_over, .. } = self;
        stream.warnings.extend(passed_over.sentence().map(|it| text.warning(it)));
        stream.observed = passed_over.observed;
        stream.unread = passed_over.ephemerides;
        let seconds: Vec<_> = epochs.iter().map(|(time, _)| 1e-3 * *time as f64).collect();
        // The weeks of Galileo and BeiDou are unambiguous.
        let near =
            dated(&ephemerides, &seconds, true).or_else(|| dated(&ephemerides, &seconds, false));
        let Some((place, near)) = near else {
            let problem =
                "expected a message that tells the week (1019, 1042, 1045 or 1046), found none";
            return if epochs.is_empty() { Ok(stream) } else { Err(text.error(problem)) };
        };
        stream.channels = glonass.join(&mut epochs, 1_000 * near.leap_seconds() as i64);
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
