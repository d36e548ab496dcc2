/// The length of a day, s.
const DAY: f64 = 86_400.0;
/// The length of a week, s.
const WEEK: f64 = 604_800.0;
/// The first day (modified Julian date) of the first GPS week.
const FIRST_WEEK: i32 = 44_244;

/// An instant in GPS time: the day counted as a modified Julian date, and the second of that day.
///
/// A single number of seconds could not resolve a nanosecond, in which a satellite moves by micrometres, over a
/// century.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GpsTime {
    day: i32,
    second: f64,
}

impl GpsTime {
    /// The offset of GPS time from BeiDou time, s: BeiDou time is behind.
    pub const BEIDOU_BEHIND: f64 = 14.0;

    /// The instant `second` seconds after the midnight that begins day `day` (modified Julian date), normalised to its
    /// own day.
    ///
    /// A second that is not finite or is beyond ten thousand years is kept as it is: what is computed with it will not
    /// be finite, or be far from everything.
    pub fn new(day: i32, second: f64) -> Self {
        let days = libm::floor(second / DAY);
        if days == 0.0 || !(-4e6..4e6).contains(&days) {
            return Self { day, second };
        }
        // A tiny negative second rounds to a whole day.
        let second = second - days * DAY;
        let (days, second) = if second < DAY { (days, second) } else { (days + 1.0, 0.0) };
        Self { day: day.saturating_add(days as i32), second }
    }

    /// The instant `second` seconds into day `day`, for constants; `second` is taken as it is.
    pub const fn new_in_day(day: i32, second: f64) -> Self {
        Self { day, second }
    }

    /// The modified Julian date of the day.
    pub const fn day(self) -> i32 {
        self.day
    }

    /// The second of the day, from 0 below 86 400.
    pub const fn second(self) -> f64 {
        self.second
    }

    /// Seconds since the beginning of the GPS week.
    pub fn second_of_week(self) -> f64 {
        let day = self.day.saturating_sub(FIRST_WEEK).rem_euclid(7);
        f64::from(day) * DAY + self.second
    }

    /// The instant nearest to this one with a given second of the week, for messages that do not tell the week.
    pub fn nearest_second_of_week(self, second: f64) -> Self {
        let away = second - self.second_of_week();
        self.plus(away - libm::round(away / WEEK) * WEEK)
    }

    /// This instant `seconds` later.
    pub fn plus(self, seconds: f64) -> Self {
        Self::new(self.day, self.second + seconds)
    }

    /// Seconds from `earlier` to this instant.
    pub fn since(self, earlier: Self) -> f64 {
        f64::from(self.day.saturating_sub(earlier.day)) * DAY + (self.second - earlier.second)
    }

    /// Days since J2000.0 (2000-01-01 12:00), in the time scale that is `offset` seconds ahead of
    /// GPS time.
    pub fn days_since_j2000(self, offset: f64) -> f64 {
        f64::from(self.day.saturating_sub(51_544)) + ((self.second + offset) / DAY - 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::GpsTime;

    #[test]
    fn seconds_are_brought_into_their_day() {
        assert_eq!(GpsTime::new(59_025, 86_430.0), GpsTime::new(59_026, 30.0));
        assert_eq!(GpsTime::new(59_025, -0.5), GpsTime::new(59_024, 86_399.5));
        assert_eq!(GpsTime::new(1, -1e-20), GpsTime::new(1, 0.0));
        assert_eq!(
            GpsTime::new(59_025, 0.0).plus(90_000.0).since(GpsTime::new(59_025, 3_600.0)),
            86_400.0
        );
    }

    #[test]
    fn a_second_of_the_week_is_the_nearest_one() {
        // A Thursday at noon.
        let noon = GpsTime::new(59_025, 43_200.0);
        assert_eq!(noon.second_of_week(), 4.0 * 86_400.0 + 43_200.0);
        let away = |second| noon.nearest_second_of_week(second).since(noon);
        assert_eq!([away(388_800.0), away(388_801.0), away(388_700.0)], [0.0, 1.0, -100.0]);
        // Within half a week, across its ends.
        assert_eq!([away(0.0), away(86_390.0), away(86_410.0)], [216_000.0, 302_390.0, -302_390.0]);
    }

    #[test]
    fn nonsense_stays_nonsense() {
        assert!(GpsTime::new(0, f64::NAN).since(GpsTime::new(0, 0.0)).is_nan());
        assert!(GpsTime::new(i32::MAX, 1e300).since(GpsTime::new(i32::MIN, 0.0)) > 1e13);
    }
}
