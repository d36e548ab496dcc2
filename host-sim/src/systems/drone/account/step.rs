//! A step in the levels of a flight: another gain, another antenna, another transmitter.

use crate::metrics::mean;
use crate::systems::drone::recording::flight::Stop;

/// Fewer measurements on either side say nothing of a step.
const FEWEST: usize = 3;
/// The same as a share of all.
const SHARE: f64 = 0.1;
/// A step of fewer dB may be shadowing: of eight flights that were looked at, none had one of more than 4.4.
const LEAST_DB: f64 = 10.0;
/// What is left of the variance with a step in the model is less than this share; it was 0.65 and more without one.
const LEFT: f64 = 0.5;

/// When the levels step, s, and by how much, dB, as seen from the estimated place.
///
/// Residuals are of the loss of free space: an exponent that is a little wrong makes a slope, not a step.
pub(super) fn step(stops: &[Stop], place: [f64; 2]) -> Option<(f64, f64)> {
    let residual = |stop: &Stop| {
        let [x, y] = [0, 1].map(|axis| stop.place[axis] - place[axis]);
        // A received level is a negative loss.
        -stop.loss + 20.0 * x.hypot(y).hypot(stop.height).max(1.0).log10()
    };
    let residuals: Vec<f64> = stops.iter().map(residual).collect();
    let (count, mean) = (residuals.len(), mean(&residuals));
    let squares: f64 = residuals.iter().map(|it| (it - mean).powi(2)).sum();
    let margin = FEWEST.max((SHARE * count as f64) as usize);
    let last = count.checked_sub(margin)?;
    let mut sum = 0.0;
    // Of each place: by how much the means before and after differ, and how much of the squares that explains.
    let splits = residuals.iter().enumerate().map(|(at, residual)| {
        let (before, after) = (at as f64, (count - at) as f64);
        // The residuals without their mean sum up to nothing.
        let by = -sum / after - sum / before;
        sum += residual - mean;
        (at, by, by * by * before * after / count as f64)
    });
    let inside = splits.filter(|(at, ..)| (margin..=last).contains(at));
    let (split, by, explained) = inside.max_by(|a, b| a.2.total_cmp(&b.2))?;
    let is_step = squares - explained < LEFT * squares;
    (is_step && by.abs() > LEAST_DB).then(|| (stops[split].t, by))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle around the place, with a little noise and a step.
    fn flight(by: f64) -> Vec<Stop> {
        let stop = |k: u32| {
            let angle = f64::from(k) * 0.2;
            let place = [300.0 * angle.cos(), 50.0 + 200.0 * angle.sin()];
            let distance = place[0].hypot(place[1]).hypot(40.0);
            let noise = f64::from(k * 7919 % 13) - 6.0;
            let step = if k < 20 { 0.0 } else { by };
            Stop {
                t: f64::from(k),
                place,
                height: 40.0,
                loss: 20.0 * distance.log10() + noise - step,
            }
        };
        (0..50).map(stop).collect()
    }

    #[test]
    fn a_step_is_found_where_it_is() {
        assert_eq!(step(&flight(0.0), [0.0, 0.0]), None);
        let (at, by) = step(&flight(-20.0), [0.0, 0.0]).expect("a step");
        assert!(at == 20.0 && (by + 20.0).abs() < 2.0, "{by} dB at {at} s");
        assert_eq!(step(&flight(20.0)[..4], [0.0, 0.0]), None);
    }
}
