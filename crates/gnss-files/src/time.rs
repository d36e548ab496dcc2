//! GPS time, the calendar and leap seconds.

/// The length of a day, s.
const DAY: f64 = 86_400.0;

/// The days (modified Julian date) at whose beginning UTC fell another second behind GPS time, from 1981 on.
const LEAPS: [i32; 18] = [
    44_786, 45_151, 45_516, 46_247, 47_161, 47_892, 48_257, 48_804, 49_169, 49_534, 50_083, 50_630,
    51_179, 53_736, 54_832, 56_109, 57_204, 57_754,
];

/// An instant in GPS time: a day, and the second of that day.
///
/// A single number of seconds could not resolve a nanosecond over a century.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct GpsTime {
    day: i32,
    second: f64,
}

impl GpsTime {
    /// The offset of GPS time from BeiDou time, s: BeiDou time is behind.
    pub(crate) const BEIDOU_BEHIND: f64 = 14.0;

    /// The instant at which GPS time began.
    #[cfg(any(feature = "rtcm", feature = "ubx"))]
    pub(crate) const EPOCH: Self = Self { day: 44_244, second: 0.0 };

    /// The instant `second` seconds after the midnight that begins day `day` (modified Julian date), normalised to its
    /// own day.
    ///
    /// A second that is not finite or is beyond ten thousand years is kept as it is.
    pub fn new(day: i32, second: f64) -> Self {
        let days = (second / DAY).floor();
        if days == 0.0 || !(-4e6..4e6).contains(&days) {
            return Self { day, second };
        }
        // A tiny negative second rounds to a whole day.
        let second = second - days * DAY;
        let (days, second) = if second < DAY { (days, second) } else { (days + 1.0, 0.0) };
        Self { day: day.saturating_add(days as i32), second }
    }

    /// Converts an instant in BeiDou time to GPS time.
    pub(crate) fn beidou_to_gps(self) -> Self {
        Self::new(self.day, self.second + Self::BEIDOU_BEHIND)
    }

    /// The instant of a year, month, day, hour and minute of the Gregorian calendar and a second, all in GPS time.
    ///
    /// `None` if there is no such day or time, or outside the years 1900 to 2200. The hour may be 24 and the second 60,
    /// as some programs round.
    pub fn from_calendar([year, month, day, hour, minute]: [i32; 5], second: f64) -> Option<Self> {
        let leap_year = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
        let days = match month {
            2 if leap_year => 29,
            2 => 28,
            4 | 6 | 9 | 11 => 30,
            1..=12 => 31,
            _ => return None,
        };
        let fits = (1900..=2200).contains(&year)
            && (1..=days).contains(&day)
            && (0..=24).contains(&hour)
            && (0..60).contains(&minute)
            && (0.0..=60.0).contains(&second);
        if !fits {
            return None;
        }
        // The year is counted from March, so that the leap day ends it.
        let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
        let days = 365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day;
        let seconds = f64::from(3600 * hour + 60 * minute) + second;
        Some(Self::new(days - 678_882, seconds))
    }

    /// The day as a modified Julian date.
    pub const fn day(self) -> i32 {
        self.day
    }

    /// The second of the day, from 0 below 86 400.
    pub const fn second(self) -> f64 {
        self.second
    }

    /// Seconds from `earlier` to this instant.
    pub fn since(self, earlier: Self) -> f64 {
        f64::from(self.day.saturating_sub(earlier.day)) * DAY + (self.second - earlier.second)
    }

    /// GPS time minus UTC, s: leap seconds up to that of 1 January 2017, the last one announced.
    pub fn leap_seconds(self) -> f64 {
        let passed = LEAPS
            .iter()
            .enumerate()
            .take_while(|&(already, &day)| self.since(Self::new(day, 0.0)) >= (already + 1) as f64);
        passed.count() as f64
    }
}

/// The full year of a two-digit year: from 1980 to 2079.
pub(crate) fn full_year(year: i32) -> i32 {
    match year {
        80..=99 => 1900 + year,
        0..=79 => 2000 + year,
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_of_the_calendar() {
        let at = |year, month, day| GpsTime::from_calendar([year, month, day, 0, 0], 0.0);
        let day = |year, month, day| at(year, month, day).map(GpsTime::day);
        assert_eq!(day(2000, 1, 1), Some(51_544));
        assert_eq!(day(2020, 6, 25), Some(59_025));
        assert_eq!(day(2008, 5, 27), Some(54_613));
        assert_eq!(day(2000, 2, 29), Some(51_603));
        assert_eq!(day(2000, 3, 1), Some(51_604));
        assert_eq!(day(2100, 2, 29), None);
        assert_eq!(day(2023, 13, 1), None);
        assert_eq!(day(2023, 4, 31), None);
        let midnight = GpsTime::from_calendar([2020, 6, 24, 23, 59], 60.0);
        assert_eq!(midnight, Some(GpsTime::new(59_025, 0.0)));
        assert_eq!(midnight, GpsTime::from_calendar([2020, 6, 24, 24, 0], 0.0));
        assert_eq!(GpsTime::from_calendar([2020, 6, 24, 0, 0], f64::NAN), None);
        assert_eq!(GpsTime::from_calendar([i32::MAX, 6, 24, i32::MAX, i32::MIN], 0.0), None);
    }

    #[test]
    fn seconds_between_gps_and_utc() {
        let at = |year, month, day, second| {
            let time = GpsTime::from_calendar([year, month, day, 0, 0], second);
            time.map(GpsTime::leap_seconds)
        };
        assert_eq!(at(1980, 1, 6, 0.0), Some(0.0));
        assert_eq!(at(1981, 7, 1, 1.0), Some(1.0));
        assert_eq!(at(2008, 5, 27, 0.0), Some(14.0));
        assert_eq!(at(2017, 1, 1, 17.0), Some(17.0));
        assert_eq!(at(2017, 1, 1, 18.0), Some(18.0));
        assert_eq!(at(2020, 6, 25, 0.0), Some(18.0));
    }

    #[test]
    fn seconds_are_brought_into_their_day() {
        assert_eq!(GpsTime::new(59_025, 86_430.0), GpsTime::new(59_026, 30.0));
        assert_eq!(GpsTime::new(59_025, -0.5), GpsTime::new(59_024, 86_399.5));
        assert_eq!(GpsTime::new(1, -1e-20), GpsTime::new(1, 0.0));
        assert!(GpsTime::new(0, f64::NAN).since(GpsTime::new(0, 0.0)).is_nan());
        assert!(GpsTime::new(i32::MAX, 1e300).since(GpsTime::new(i32::MIN, 0.0)) > 1e13);
    }
}
