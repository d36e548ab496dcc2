//! Resolution of weeks: observation messages do not give them, and ephemerides give them only modulo 1024 or in another
//! time system.

use super::Epoch;
use super::ephemerides::{ROLLOVER, WEEK};
use crate::navigation::{Ephemeris, Message as Of};
use crate::time::GpsTime;

/// Half a week, ms: time does not step farther back than this.
const HALF_WEEK: i64 = 302_400_000;
/// Half a week, s.
const HALF_WEEK_S: f64 = 302_400.0;

/// The index of an epoch, and an instant near it, from the ephemerides of Galileo and BeiDou, or of GPS; `seconds` are
/// those of the epochs in their weeks.
///
/// Some senders give the week of the transmission, as satellites do, others that of the ephemeris: ephemerides for
/// which both are the same are preferred.
pub(super) fn dated(
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

/// The time from the first epoch to each, ms.
pub(super) fn elapsed(epochs: &[Epoch]) -> Vec<i64> {
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

/// The time of an ephemeris moved to the week in which it is within half a week of an epoch; the transmitted week is at
/// most one off.
pub(super) fn in_week_of(time: GpsTime, epoch: GpsTime) -> GpsTime {
    let away = (epoch.since(time) / (2.0 * HALF_WEEK_S)).round().clamp(-1.0, 1.0);
    GpsTime::new(time.day() + WEEK * away as i32, time.second())
}

/// The time since the beginning of the GPS week, s.
pub(super) fn second_of_week(time: GpsTime) -> f64 {
    f64::from((time.day() - GpsTime::EPOCH.day()).rem_euclid(WEEK)) * 86_400.0 + time.second()
}

/// The time moved by multiples of 1024 weeks to be nearest to `near`.
pub(super) fn rolled_to(time: GpsTime, near: GpsTime) -> GpsTime {
    let away = f64::from(near.day() - time.day()) / f64::from(WEEK * ROLLOVER);
    GpsTime::new(time.day() + away.round() as i32 * WEEK * ROLLOVER, time.second())
}
