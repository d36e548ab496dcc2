//! Infers the unit of a time column that names none from the spacing of its times.

use std::ops::RangeInclusive;

use crate::error::Error;
use crate::unit::{Quantity, Unit};

/// The number of times that are looked at to find the usual step.
const SAMPLE: usize = 4000;
/// The largest usual step, s, of times of day that are recognised: within a minute there are several.
const LONGEST_OF_DAY: f64 = 10.0;

/// The duration, s, of a log that is rather one in a smaller unit: a day.
const LONGEST_LOG: f64 = 86_400.0;

/// Refuses hours, minutes and seconds in one number, such as 115959.5 before 120000, as NMEA writes them: taken for seconds, each
/// minute would last for a hundred. No time has more than 59 minutes or 60 seconds then, and where a minute or an hour
/// ends, the next time is 40 or 4040 more than a step away. Thousandths of seconds may follow without a sign.
///
/// # Errors
/// [`Error::Undecided`] with the times at the end of a minute or an hour.
pub(crate) fn refuse_times_of_day(times: &[f64], option: &str) -> Result<(), Error> {
    for thousandths in [1.0, 1e3] {
        let of_day = |time: &f64| {
            let time = time / thousandths;
            let (minutes, seconds) = ((time / 100.0).floor(), time.rem_euclid(100.0));
            (0.0..240_000.0).contains(&time) && minutes % 100.0 < 60.0 && seconds < 61.0
        };
        if !times.iter().all(of_day) {
            continue;
        }
        let steps = times.windows(2).map(|pair| (pair[1] - pair[0]) / thousandths);
        let steps = steps.filter(|step| *step > 0.0 && *step < LONGEST_OF_DAY);
        let longest = steps.fold(0.0, f64::max);
        let ends = |pair: &&[f64]| {
            let [before, after] = [pair[0], pair[1]].map(|time| time / thousandths);
            let step = |skipped: f64| after - before - skipped;
            let is_step = |step: f64| step > 0.0 && step < 1.5 * longest;
            (before / 100.0).floor() < (after / 100.0).floor()
                && [40.0, 4040.0].map(step).into_iter().any(is_step)
        };
        if let Some([before, after]) = times.windows(2).find(ends) {
            let problem = format!(
                "expected times in s, found hours, minutes and seconds in one number ({before} before {after}): write them with colons"
            );
            return Err(Error::undecided(problem, option));
        }
    }
    Ok(())
}

/// The unit in which the usual step of the times lies in the range `usual`, s: seconds if they fit and the log does not last longer
/// than a day then, or else the one unit that fits.
///
/// # Errors
/// [`Error::Undecided`] if no unit fits, or several that are shorter than a second; or if the times are hours, minutes and
/// seconds in one number.
pub fn unit_of_times(
    times: impl IntoIterator<Item = f64>,
    usual: RangeInclusive<f64>,
) -> Result<Unit, Error> {
    const OPTION: &str = "--units t=";
    let times: Vec<f64> = times.into_iter().collect();
    refuse_times_of_day(&times, OPTION)?;
    let sample = times.get(..SAMPLE).unwrap_or(&times);
    let mut steps: Vec<f64> = sample.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.retain(|step| *step > 0.0 && step.is_finite());
    let units: Vec<_> = ["s", "ms", "us", "ns"]
        .iter()
        .filter_map(|name| Unit::read(Quantity::Time, name))
        .collect();
    let middle = steps.len() / 2;
    if steps.is_empty() {
        return Ok(Unit::new(1.0, "s"));
    }
    let (_, &mut step, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
    let fitting: Vec<_> =
        units.iter().filter(|unit| usual.contains(&(step * unit.scale))).collect();
    let lasts = times.last().zip(times.first()).map_or(0.0, |(last, first)| (last - first).abs());
    match fitting[..] {
        [first, other] if first.scale == 1.0 && lasts > LONGEST_LOG => Ok(other.clone()),
        [first, ..] if first.scale == 1.0 => Ok(first.clone()),
        [only] => Ok(only.clone()),
        _ => Err(Error::undecided(format!("expected times in s, found steps of {step}"), OPTION)),
    }
}

/// The largest mean step of a log of ranges, s, and the duration, s, that every such log exceeds.
const SLOWEST: f64 = 60.0;
const SHORTEST_LOG: f64 = 10.0;

/// The unit of the times of ranges, as [`unit_of_times`] finds it.
///
/// Seconds are taken instead if the log would otherwise be implausibly short and its times have decimals.
///
/// # Errors
/// As [`unit_of_times`].
pub fn unit_of_range_times(
    times: impl IntoIterator<Item = f64>,
    usual: RangeInclusive<f64>,
) -> Result<Unit, Error> {
    let times: Vec<f64> = times.into_iter().filter(|time| time.is_finite()).collect();
    let unit = unit_of_times(times.iter().copied(), usual)?;
    let [first, last] = [times.first(), times.last()].map(|time| time.copied().unwrap_or_default());
    let is_over = (last - first).abs() * unit.scale < SHORTEST_LOG;
    let is_slow = (last - first).abs() <= SLOWEST * times.len() as f64;
    let has_decimals = || times.iter().any(|time| time.fract() != 0.0);
    if unit.scale == 1e-3 && is_over && is_slow && has_decimals() {
        return Ok(Unit::new(1.0, "s"));
    }
    Ok(unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times of day, from `begin` on for `seconds`, `rate` of them a second, as numbers with their parts side by side.
    fn of_day(begin: u32, seconds: u32, rate: u32) -> Vec<f64> {
        let time = |k| {
            let (second, part) = (begin + k / rate, f64::from(k % rate) / f64::from(rate));
            let clock = second / 3600 * 10_000 + second / 60 % 60 * 100 + second % 60;
            f64::from(clock) + part
        };
        (0..seconds * rate).map(time).collect()
    }

    #[test]
    fn times_of_day_in_one_number_are_no_seconds() {
        let refused = |times: &[f64]| {
            let error = unit_of_times(times.iter().copied(), 2e-3..=2.0).err();
            error.is_some_and(|error| error.to_string().contains("hours, minutes and seconds"))
        };
        for rate in [1, 10, 100] {
            assert!(refused(&of_day(43_170, 120, rate)), "{rate}");
            // Over the end of one minute, and of one hour.
            assert!(refused(&of_day(43_250, 20, rate)));
            assert!(refused(&of_day(43_190, 20, rate)));
            let thousandths =
                of_day(32_330, 600, rate).into_iter().map(|time| (time * 1e3).round());
            assert!(refused(&thousandths.collect::<Vec<_>>()));
        }
        // With a gap in which some minutes end, but not all.
        let mut times = of_day(36_000, 3600, 5);
        times.drain(2_000..9_000);
        assert!(refused(&times));
        // Within a minute they are seconds; and seconds are.
        assert!(!refused(&of_day(36_000, 50, 10)));
        for step in [0.01, 0.1, 1.0] {
            let seconds: Vec<_> = (0..40_000).map(|k| 17.0 + f64::from(k) * step).collect();
            assert!(!refused(&seconds), "{step}");
        }
        // A pause in seconds, of any length.
        for pause in 1..1000 {
            let seconds = (0..4000)
                .map(|k| f64::from(k) * 0.1 + if k < 590 { 0.0 } else { f64::from(pause) * 0.1 });
            assert!(!refused(&seconds.collect::<Vec<_>>()), "{pause}");
        }
    }

    #[test]
    fn the_spacing_tells_the_unit() {
        let times = |step: f64| (0..100).map(|i| 17.0 + f64::from(i) * step).collect::<Vec<_>>();
        for (step, unit) in [(0.05, "s"), (1.0, "s"), (50.0, "ms"), (5e4, "µs"), (5e7, "ns")] {
            assert_eq!(unit_of_times(times(step), 2e-3..=2.0).unwrap().name, unit);
        }
        assert_eq!(unit_of_times(times(100.0), 2e-2..=60.0).unwrap().name, "ms");
        assert_eq!(unit_of_times([1.0], 2e-3..=2.0).unwrap().name, "s");
        // Slow ranges: 100 of them do not make a log of half a second, but 4000 make one of 18 s.
        let slow = |step: f64, count: i32| {
            let times = (0..count).map(|i| 17.5 + f64::from(i) * step);
            unit_of_range_times(times, 2e-3..=2.0).unwrap().name
        };
        assert_eq!([slow(4.58, 100), slow(4.58, 4000), slow(10.02, 3000)], ["s", "ms", "ms"]);
        assert_eq!([slow(0.05, 100), slow(50.02, 4000)], ["s", "ms"]);
        let whole = (0..100).map(|i| f64::from(5 * i));
        assert_eq!(unit_of_range_times(whole, 2e-3..=2.0).unwrap().name, "ms");
        assert_eq!(unit_of_times((0..3600).map(f64::from), 2e-3..=2.0).unwrap().name, "s");
        // A hundred hertz for two minutes, rather than a measurement each ten seconds for 33 hours.
        let tens = |count: i32| (0..count).map(|i| f64::from(10 * i));
        assert_eq!(unit_of_times(tens(12_000), 2e-3..=60.0).unwrap().name, "ms");
        assert_eq!(unit_of_times(tens(1000), 2e-3..=60.0).unwrap().name, "s");
        // No unit fits; a step of a thousand may be a second in ms or a millisecond in µs.
        for (step, shortest) in [(1e-7, 2e-3), (1e3, 5e-4)] {
            let error = unit_of_times(times(step), shortest..=2.0).unwrap_err().to_string();
            assert!(error.contains("--units t="), "{error}");
        }
    }
}
