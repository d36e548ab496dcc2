//! Infers the unit of a time column that names none from the spacing of its times.

use std::ops::RangeInclusive;

use crate::error::Error;
use crate::unit::{Quantity, Unit};

/// The number of times that are looked at to find the usual step.
const SAMPLE: usize = 4000;

/// The unit in which the usual step of the times lies in the range `usual`, s: seconds if they fit, or else the one
/// unit that fits.
///
/// # Errors
/// [`Error::Undecided`] if no unit fits, or several that are shorter than a second.
pub fn unit_of_times(
    times: impl IntoIterator<Item = f64>,
    usual: RangeInclusive<f64>,
) -> Result<Unit, Error> {
    let times: Vec<f64> = times.into_iter().take(SAMPLE).collect();
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
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
    match fitting[..] {
        [first, ..] if first.scale == 1.0 => Ok(first.clone()),
        [only] => Ok(only.clone()),
        _ => Err(Error::undecided(
            format!("expected times in s, found steps of {step}"),
            "--units t=",
        )),
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
        // No unit fits; a step of a thousand may be a second in ms or a millisecond in µs.
        for (step, shortest) in [(1e-7, 2e-3), (1e3, 5e-4)] {
            let error = unit_of_times(times(step), shortest..=2.0).unwrap_err().to_string();
            assert!(error.contains("--units t="), "{error}");
        }
    }
}
