//! Dates and times of day.

/// Days between the first of January 1970 and day zero of the modified Julian date.
const UNIX_DAY: i64 = 40_587;

/// Year, month, day, hour and minute, and the second.
pub(super) type Calendar = ([i64; 5], f64);

/// The date and time of `seconds` after the midnight of `day` (modified Julian date), to the millisecond.
pub(super) fn calendar(day: i64, seconds: f64) -> Calendar {
    let milliseconds = (1e3 * seconds).round() as i64;
    let (days, rest) = (milliseconds.div_euclid(86_400_000), milliseconds.rem_euclid(86_400_000));
    // Civil date from days since the first of March of year 0 (Howard Hinnant).
    let z = day + days - UNIX_DAY + 719_468;
    let era = z.div_euclid(146_097);
    let of_era = z.rem_euclid(146_097);
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let date = of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = year + era * 400 + i64::from(month <= 2);
    let (hour, minute) = (rest / 3_600_000, rest / 60_000 % 60);
    ([year, month, date, hour, minute], (rest % 60_000) as f64 / 1e3)
}

/// A readable date and time, to the millisecond if the second is not whole.
pub(super) fn in_words(([year, month, day, hour, minute], second): Calendar) -> String {
    let (digits, decimals) = if second.fract() == 0.0 { (2, 0) } else { (6, 3) };
    format!("{year:04}-{month:02}-{day:02} {hour:02}:{minute:02}:{second:0digits$.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_of_the_calendar() {
        assert_eq!(calendar(59_025, 0.0), ([2020, 6, 25, 0, 0], 0.0));
        assert_eq!(calendar(59_025, 86_399.999_6), ([2020, 6, 26, 0, 0], 0.0));
        assert_eq!(calendar(51_544, -18.0), ([1999, 12, 31, 23, 59], 42.0));
        assert_eq!(calendar(60_369, 45_296.5), ([2024, 2, 29, 12, 34], 56.5));
    }

    #[test]
    fn seconds_have_decimals_where_there_are_any() {
        assert_eq!(in_words(calendar(59_025, -18.0)), "2020-06-24 23:59:42");
        assert_eq!(in_words(calendar(59_025, 3_605.25)), "2020-06-25 01:00:05.250");
    }
}
