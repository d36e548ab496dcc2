//! Parses dates and times of day.

use std::time::UNIX_EPOCH;

/// A field that is a date with a time, or a time of day.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Moment {
    /// Microseconds since 1970, UTC if no zone is given.
    Date(f64),
    /// Microseconds since midnight.
    OfDay(f64),
}

impl Moment {
    /// The time in microseconds.
    pub(crate) fn microseconds(self) -> f64 {
        match self {
            Self::Date(value) | Self::OfDay(value) => value,
        }
    }
}

/// Continues times of day after midnight.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Days {
    /// The last time, s since the midnight before the first one.
    last: Option<f64>,
}

impl Days {
    /// The time of a moment, s since 1970 or since the midnight before the first moment. Of all days from the first one on, a time
    /// of day belongs to that on which it is nearest to the time before.
    pub(crate) fn seconds(&mut self, moment: Moment) -> f64 {
        const DAY: f64 = 86_400.0;
        let seconds = moment.microseconds() * 1e-6;
        let Moment::OfDay(_) = moment else { return seconds };
        let days = self.last.map_or(0.0, |last| ((last - seconds) / DAY).round().max(0.0));
        *self.last.insert(seconds + days * DAY)
    }
}

/// Reads ISO 8601 (`2024-05-01T10:00:00.25+03:00`, with a blank or slashes too) or a time of day (`10:00:00.25`).
pub(crate) fn read(field: &[u8]) -> Option<Moment> {
    const LONGEST: usize = 40;
    if field.len() > LONGEST || !field.contains(&b':') {
        return None;
    }
    let text = std::str::from_utf8(field).ok()?;
    match text.find(['T', 't', ' ']) {
        Some(at) => date(text.get(..at)?, text.get(at + 1..)?.trim()),
        None => of_day(text).map(Moment::OfDay),
    }
}

fn date(day: &str, clock: &str) -> Option<Moment> {
    let (clock, east) = zone(clock)?;
    let of_day = of_day(clock)?;
    let midnight = format!("{}T00:00:00Z", day.replace('/', "-"));
    let midnight = humantime::parse_rfc3339(&midnight).ok()?;
    let midnight = midnight.duration_since(UNIX_EPOCH).ok()?.as_secs_f64();
    Some(Moment::Date((midnight - east) * 1e6 + of_day))
}

/// A time without its zone, and the zone's offset east of UTC, s.
fn zone(clock: &str) -> Option<(&str, f64)> {
    if let Some(clock) = clock.strip_suffix(['Z', 'z']) {
        return Some((clock.trim(), 0.0));
    }
    let Some(at) = clock.find(['+', '-']) else { return Some((clock, 0.0)) };
    let (clock, zone) = clock.split_at(at);
    let sign = if zone.starts_with('-') { -1.0 } else { 1.0 };
    let digits: String = zone.chars().filter(char::is_ascii_digit).collect();
    let hours: f64 = digits.get(..2)?.parse().ok()?;
    let minutes: f64 =
        digits.get(2..).filter(|rest| !rest.is_empty()).unwrap_or("0").parse().ok()?;
    Some((clock.trim(), sign * (hours * 3600.0 + minutes * 60.0)))
}

/// The microseconds since midnight of a time such as `10:00:00.25`.
fn of_day(clock: &str) -> Option<f64> {
    let mut parts = clock.split(':');
    let hours: u32 = parts.next().filter(|text| is_digits(text, 2))?.parse().ok()?;
    let minutes: u32 = parts.next().filter(|text| is_digits(text, 2))?.parse().ok()?;
    let seconds = parts.next()?.replace(',', ".");
    let (whole, fraction) = seconds.split_once('.').unwrap_or((&seconds, "0"));
    let is_clock = is_digits(whole, 2) && is_digits(fraction, 12) && parts.next().is_none();
    let seconds: f64 = seconds.parse().ok()?;
    let is_time = is_clock && hours < 24 && minutes < 60 && seconds < 61.0;
    is_time.then(|| f64::from(hours * 3600 + minutes * 60) * 1e6 + (seconds * 1e6).round())
}

fn is_digits(text: &str, most: usize) -> bool {
    (1..=most).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_and_times_of_day_are_read() {
        let second = 1_714_557_600e6;
        for (text, expected) in [
            ("2024-05-01T10:00:00Z", Moment::Date(second)),
            ("2024-05-01 10:00:00.000001", Moment::Date(second + 1.0)),
            ("2024/05/01 13:00:00,5+03:00", Moment::Date(second + 500_000.0)),
            ("2024-05-01T05:30:00.5-0430", Moment::Date(second + 500_000.0)),
            ("10:00:00.25", Moment::OfDay(36_000_250_000.0)),
            ("23:59:60.5", Moment::OfDay(86_400_500_000.0)),
        ] {
            assert_eq!(read(text.as_bytes()), Some(expected), "{text}");
        }
        for text in
            ["", "10:00", "25:00:00", "2024-13-01T00:00:00Z", "a:b:c", "1:2:3:4", "12:0x:00"]
        {
            assert_eq!(read(text.as_bytes()), None, "{text}");
        }
    }
}
