//! The unit of times that nothing names: from their spacing.

use std::ops::RangeInclusive;

use crate::error::Error;
use crate::unit::{Quantity, Unit};

/// Enough to tell the usual step.
const SAMPLE: usize = 4000;
/// Steps of no more than this, s, may be seconds still if times have decimals: clocks of milliseconds and less count whole ones.
const SLOWEST: f64 = 60.0;

/// The unit of times whose usual step is one of these, in s: seconds if they may be, or else the one unit that fits. Times with
/// decimals whose steps are longer are seconds, too, up to a minute.
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
    if step > *usual.end() && step <= SLOWEST && times.iter().any(|time| time.fract() != 0.0) {
        return Ok(Unit::new(1.0, "s"));
    }
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
        // Slow ones have decimals if they are seconds, and none if they are milliseconds.
        assert_eq!(unit_of_times(times(4.58), 2e-3..=2.0).unwrap().name, "s");
        assert_eq!(unit_of_times(times(5.0), 2e-3..=2.0).unwrap().name, "ms");
        assert_eq!(unit_of_times([1.0], 2e-3..=2.0).unwrap().name, "s");
        // Nothing fits; and a thousand may be a second in ms or a millisecond in µs.
        for (step, shortest) in [(1e-7, 2e-3), (1e3, 5e-4)] {
            let error = unit_of_times(times(step), shortest..=2.0).unwrap_err().to_string();
            assert!(error.contains("--units t="), "{error}");
        }
    }
}
