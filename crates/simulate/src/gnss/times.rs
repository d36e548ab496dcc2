//! The epochs of a day and the samples of its products.

use kestirim_gnss_ppp::GpsTime;

/// The time between epochs, and between samples of the satellites' clocks, s.
pub const INTERVAL_S: f64 = 30.0;
/// The number of epochs of a day.
pub const EPOCHS: u32 = 2880;
/// UTC minus GPS time, s.
pub const UTC_MINUS_GPS: f64 = -18.0;
/// The midnight at which all days begin: 1 September 2019, the first of the paper's.
pub const MIDNIGHT: GpsTime = GpsTime::new_in_day(58_727, 0.0);
/// The number of clock samples before midnight with which the products begin, and after the next midnight with which
/// they end: two hours.
pub(super) const LAST: f64 = 240.0;
/// The number of samples of a clock.
pub(super) const SAMPLES: usize = 2880 + 2 * 240 + 1;
