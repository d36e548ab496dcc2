//! Times in the formats of files and receivers.

use kestirim_gnss_ppp::GpsTime;

/// The modified Julian day on which GPS time begins: 6 January 1980.
const FIRST_DAY: i32 = 44_244;

/// Parses a time of six fields: year, month, day, hour, minute and second.
pub(crate) fn date<'a>(fields: &mut impl Iterator<Item = &'a str>) -> Option<GpsTime> {
    let mut whole = || fields.next()?.parse::<i32>().ok();
    let (year, month, day, hour, minute) = (whole()?, whole()?, whole()?, whole()?, whole()?);
    let second = fields.next()?.parse::<f64>().ok()?;
    let sensible = (1980..2200).contains(&year)
        && (1..=12).contains(&month)
        && (1..=31).contains(&day)
        && (0..24).contains(&hour)
        && (0..60).contains(&minute)
        && (0.0..60.0).contains(&second);
    let minutes = 60 * hour + minute;
    sensible.then(|| {
        GpsTime::new(modified_julian_day(year, month, day), f64::from(60 * minutes) + second)
    })
}

/// The time of a GPS week and the second within it.
pub(crate) fn week(week: u16, second: f64) -> GpsTime {
    GpsTime::new(FIRST_DAY + 7 * i32::from(week), second)
}

/// The modified Julian day of a date, after Fliegel and van Flandern (1968), whose divisions round towards zero.
const fn modified_julian_day(year: i32, month: i32, day: i32) -> i32 {
    let early = (month - 14) / 12;
    1461 * (year + 4800 + early) / 4 + 367 * (month - 2 - 12 * early) / 12
        - 3 * ((year + 4900 + early) / 100) / 4
        + day
        - 2_432_076
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Option<GpsTime> {
        date(&mut text.split_whitespace())
    }

    #[test]
    fn dates_become_days() {
        assert_eq!(read("2020  6 25 12  0  0.00000000"), Some(GpsTime::new(59_025, 43_200.0)));
        assert_eq!(read("1980 01 06 00 00 30.500000"), Some(GpsTime::new(FIRST_DAY, 30.5)));
        assert_eq!(read("2000 3 1 23 59 0"), Some(GpsTime::new(51_604, 86_340.0)));
        assert_eq!(read("2000 2 29 0 0 0"), Some(GpsTime::new(51_603, 0.0)));
        assert_eq!(week(2111, 388_800.0), GpsTime::new(59_025, 43_200.0));
    }

    #[test]
    fn what_is_no_date_is_none() {
        for text in ["", "2020 6 25 12 0", "2020 13 1 0 0 0", "2020 1 1 0 0 nan", "99999 1 1 0 0 0"]
        {
            assert_eq!(read(text), None, "{text}");
        }
    }
}
