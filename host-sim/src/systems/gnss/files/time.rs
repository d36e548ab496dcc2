//! Calendar and leap seconds.

use kestirim_gnss_ppp::GpsTime;

/// The days (modified Julian date) that began with UTC another second behind GPS time, from 1981 on.
const LEAPS: [i32; 18] = [
    44_786, 45_151, 45_516, 46_247, 47_161, 47_892, 48_257, 48_804, 49_169, 49_534, 50_083, 50_630,
    51_179, 53_736, 54_832, 56_109, 57_204, 57_754,
];

/// GPS time minus UTC, s. No second is left out or put in after 2017, as far as is known.
pub fn leap_seconds(time: GpsTime) -> f64 {
    let passed = LEAPS
        .iter()
        .enumerate()
        .take_while(|&(already, &day)| time.since(GpsTime::new(day, 0.0)) >= (already + 1) as f64);
    passed.count() as f64
}

/// The instant of a calendar's year, month, day, hour, minute and a second; none if there is no such day or
/// time. The hour may be 24 and the second 60, as some programs round.
pub fn from_calendar([year, month, day, hour, minute]: [i32; 5], second: f64) -> Option<GpsTime> {
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
    // March begins the year, so that the leap day ends it.
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let days = 365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day;
    let seconds = f64::from(3600 * hour + 60 * minute) + second;
    fits.then(|| GpsTime::new(days - 678_882, seconds))
}

/// The year of which only the last two digits are told: from 1980 to 2079.
pub(super) fn full_year(year: i32) -> i32 {
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
        let day = |year, month, day| from_calendar([year, month, day, 0, 0], 0.0).map(GpsTime::day);
        assert_eq!(day(2000, 1, 1), Some(51_544));
        assert_eq!(day(2020, 6, 25), Some(59_025));
        assert_eq!(day(2008, 5, 27), Some(54_613));
        assert_eq!(day(2000, 2, 29), Some(51_603));
        assert_eq!(day(2000, 3, 1), Some(51_604));
        assert_eq!(day(2100, 2, 29), None);
        assert_eq!(day(2023, 13, 1), None);
        assert_eq!(day(2023, 4, 31), None);
        let midnight = from_calendar([2020, 6, 24, 23, 59], 60.0);
        assert_eq!(midnight, Some(GpsTime::new(59_025, 0.0)));
        assert_eq!(midnight, from_calendar([2020, 6, 24, 24, 0], 0.0));
        assert_eq!(from_calendar([2020, 6, 24, 0, 0], f64::NAN), None);
    }

    #[test]
    fn seconds_between_gps_and_utc() {
        let at = |year, month, day, second| {
            leap_seconds(from_calendar([year, month, day, 0, 0], second).expect("a day"))
        };
        assert_eq!(at(1980, 1, 6, 0.0), 0.0);
        assert_eq!(at(1981, 7, 1, 1.0), 1.0);
        assert_eq!(at(2008, 5, 27, 0.0), 14.0);
        assert_eq!(at(2017, 1, 1, 17.0), 17.0);
        assert_eq!(at(2017, 1, 1, 18.0), 18.0);
        assert_eq!(at(2020, 6, 25, 0.0), 18.0);
    }
}
