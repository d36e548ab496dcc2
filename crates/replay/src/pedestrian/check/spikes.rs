//! Single outlying samples: a wrong bit on a bus, a supply that breaks down.

use kestirim_health::Reason;

use super::super::Sample;
use crate::Finding;

/// The distance of an axis from its mean over the `BESIDE` samples before and after, beyond which a sample is an
/// outlier: rad/s, m/s².
const FAR: [f64; 2] = [0.5, 4.0];
const BESIDE: usize = 3;
/// The largest variation of any axis in the samples before and after, relative to that distance. What a foot does lasts
/// longer: in 31 recordings none does it.
const CALM: f64 = 0.3;
/// The fewest outliers that are reported; they must also be at least one in `ONE_IN` samples. As many again, and more,
/// are where the foot moves.
const FEWEST: usize = 3;
const ONE_IN: usize = 5000;

/// Reports the outliers of the sensor that has more of them.
pub(super) fn find(samples: &[Sample]) -> Option<Finding> {
    let rate = ("gyroscope", alone(samples, FAR[0], |it| it.angular_rate));
    let force = ("accelerometer", alone(samples, FAR[1], |it| it.specific_force));
    let (name, count) = if rate.1 >= force.1 { rate } else { force };
    (count >= FEWEST && count * ONE_IN >= samples.len()).then(|| {
        Finding::fault(
            "spikes",
            Reason::Innovations,
            format!("{count} single samples of the {name} stand alone while the foot is calm"),
            "each turns or moves the path, and there are more where the foot moves",
            "look at the bus and the supply of the sensor",
        )
    })
}

fn alone(samples: &[Sample], far: f64, of: fn(&Sample) -> [f64; 3]) -> usize {
    let is_alone = |window: &&[Sample]| {
        let beside = |axis: usize| {
            let all = window.iter().enumerate().filter(|(k, _)| *k != BESIDE);
            all.map(move |(_, sample)| of(sample)[axis])
        };
        let is_calm = |axis: usize| {
            let most = beside(axis).fold(f64::NEG_INFINITY, f64::max);
            most - beside(axis).fold(f64::INFINITY, f64::min) < CALM * far
        };
        let is_far = |axis: usize| {
            let mean = beside(axis).sum::<f64>() / (2 * BESIDE) as f64;
            (of(&window[BESIDE])[axis] - mean).abs() > far
        };
        (0..3).any(is_far) && (0..3).all(is_calm)
    };
    samples.windows(2 * BESIDE + 1).filter(is_alone).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether spikes of that height (rad/s), one in 200, are reported.
    fn told(height: f64) -> bool {
        let sample = |k: u32| {
            let t = f64::from(k) * 0.01;
            let walks = t % 1.0 > 0.5;
            let swing = if walks { 4.0 * (2.0 * std::f64::consts::TAU * t).sin() } else { 0.0 };
            let spike = if k % 200 == 20 { height } else { 0.0 };
            Sample {
                time_us: u64::from(k) * 10_000,
                specific_force: [0.0, 0.0, 9.8],
                angular_rate: [spike, swing, 0.0],
            }
        };
        let samples: Vec<Sample> = (0..2000).map(sample).collect();
        find(&samples).is_some()
    }

    #[test]
    fn spikes_while_the_foot_is_calm_are_told() {
        assert!(!told(0.0) && !told(0.2));
        assert!(told(1.0) && told(-20.0));
    }
}
