//! Combines the samples of several sensors and commands into rows.

use super::{Channel, Row};

/// The longest time for which a command holds without a new one, µs.
const LONGEST_HOLD: f64 = 1e6;
/// The quantities whose samples may define the rows, in order of preference: q, θ, V, α.
const BASES: [usize; 4] = [1, 3, 2, 0];

/// The rows, and the number of samples that no command precedes.
pub(super) fn of(channels: &[Option<Channel>; 6]) -> (Vec<Row>, usize) {
    let base = BASES.into_iter().find_map(|quantity| channels[quantity].as_ref());
    let Some(base) = base else { return (Vec::new(), 0) };
    let mut states = vec![[None; 4]; base.times.len()];
    let interval = usual_interval(&base.times);
    for (quantity, channel) in channels[..4].iter().enumerate() {
        let Some(channel) = channel else { continue };
        for (&time, &value) in channel.times.iter().zip(&channel.values) {
            let place = nearest(&base.times, time);
            if value.is_finite() && (base.times[place] - time).abs() <= interval {
                states[place][quantity] = Some(value);
            }
        }
    }
    let mut rows = Vec::with_capacity(states.len());
    for (&time, state) in base.times.iter().zip(states) {
        let held = |quantity: usize| held(channels[quantity].as_ref()?, time);
        if let (Some(elevator), Some(throttle)) = (held(4), held(5)) {
            rows.push(Row { time_us: time.round() as i64, state, input: [elevator, throttle] });
        }
    }
    let without = base.times.len() - rows.len();
    (rows, without)
}

/// The median interval between times; 0 if there is none.
fn usual_interval(times: &[f64]) -> f64 {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() {
        return 0.0;
    }
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The index of the time nearest to another one; `times` must not be empty.
fn nearest(times: &[f64], time: f64) -> usize {
    let after = times.partition_point(|&known| known < time);
    match (after.checked_sub(1), times.get(after)) {
        (Some(before), Some(next)) if time - times[before] <= next - time => before,
        (Some(before), None) => before,
        _ => after,
    }
}

/// The last command before or at a time, unless it is too old.
fn held(channel: &Channel, time: f64) -> Option<f64> {
    let place = channel.times.partition_point(|&known| known <= time).checked_sub(1)?;
    let value = channel.values[place];
    (value.is_finite() && time - channel.times[place] <= LONGEST_HOLD).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_measurement_stands_in_the_nearest_row_alone() {
        assert_eq!([4.0, 14.9, 15.1, 99.0].map(|time| nearest(&[10.0, 20.0], time)), [0, 0, 1, 1]);
        assert_eq!(usual_interval(&[0.0, 10.0, 20.0, 90.0]), 10.0);
    }
}
