//! The epochs of a day and the samples of its products.

use kestirim_gnss_ppp::GpsTime;

/// Time between epochs and between samples of the satellites' clocks, s.
pub const INTERVAL_S: f64 = 30.0;
/// Epochs of a day.
pub const EPOCHS: u32 = 2880;
/// UTC ahead of GPS time, s.
pub const UTC_MINUS_GPS: f64 = -18.0;
/// The midnight from which all days run: 1 September 2019, the paper's first.
pub const MIDNIGHT: GpsTime = GpsTime::new_in_day(58_727, 0.0);
/// Products begin so many samples of the clocks before midnight, and end as many after the next: two hours.
pub(super) const LAST: f64 = 240.0;
/// Samples of a clock.
pub(super) const SAMPLES: usize = 2880 + 2 * 240 + 1;
