//! Standstills: what the accelerometer and the gyroscope show there, and whether the gyroscope's zero moves between them.

use kestirim_health::Reason;

use super::super::Sample;
use crate::Finding;
use crate::metrics::median;

/// The length of the parts that are examined, s.
const PART_S: f64 = 0.5;
/// The largest deviation from the mean in a part at rest: in m/s² for the force, and a fifth of that in rad/s for the
/// rate.
const STILL: f64 = 0.6;
/// The fewest parts of a standstill that shows a gyroscope's zero, if that is no faster than `FASTEST`, °/s: a lift or
/// a bus may turn.
const PARTS: usize = 3;
const FASTEST: f64 = 5.0;
/// The distance between two zeros above which the zero has moved, beyond three times the differences within each, °/s.
const MOVED: f64 = 0.5;

/// A part in which the foot stands.
struct Part {
    /// The index among the log's parts.
    index: usize,
    /// Magnitude of the specific force, m/s².
    gravity: f64,
    /// Angular rate, °/s.
    rate: [f64; 3],
}

/// The zero of a gyroscope, as a standstill shows it.
struct Zero {
    /// The time, s.
    t: f64,
    /// Angular rate, °/s.
    rate: [f64; 3],
    /// The usual difference between its parts, °/s.
    apart: [f64; 3],
}

/// The findings from standstills in a log with one sample every `usual` seconds.
pub(super) fn check(samples: &[Sample], usual: f64) -> Vec<Finding> {
    let length = ((PART_S / usual).round() as usize).max(5);
    let still: Vec<Part> = samples
        .chunks_exact(length)
        .enumerate()
        .filter_map(|(index, part)| Part::of(index, part))
        .collect();
    if still.is_empty() {
        return vec![Finding::note("rest", "no standstill of half a second")];
    }
    let gravity = median(&still.iter().map(|part| part.gravity).collect::<Vec<_>>());
    let bias = middle(&still, |rate| rate);
    let seconds = PART_S * still.len() as f64;
    let mut findings = vec![
        Finding::note("rest", format!("{seconds:.1} s at rest, gravity {gravity:.3} m/s² there")),
        Finding::note(
            "gyroscope's bias",
            format!("{:.2}, {:.2}, {:.2} °/s", bias[0], bias[1], bias[2]),
        ),
    ];
    let zeros: Vec<Zero> = still
        .chunk_by(|a, b| a.index + 1 == b.index)
        .filter(|parts| parts.len() >= PARTS)
        .filter(|parts| parts.iter().flat_map(|part| part.rate).all(|rate| rate.abs() < FASTEST))
        .map(|parts| {
            let rate = middle(parts, |rate| rate);
            let apart = middle(parts, |it| std::array::from_fn(|i| (it[i] - rate[i]).abs()));
            let t = samples[parts[0].index * length].time_us as f64 * 1e-6;
            Zero { t, rate, apart }
        })
        .collect();
    findings.extend(moved(&zeros));
    findings
}

impl Part {
    /// The part, if the foot stands still in it.
    fn of(index: usize, part: &[Sample]) -> Option<Self> {
        let mean = |of: fn(&Sample) -> [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|i| {
                part.iter().map(|it| of(it)[i]).sum::<f64>() / part.len() as f64
            })
        };
        let (force, rate) = (mean(|it| it.specific_force), mean(|it| it.angular_rate));
        let is_still = part.iter().all(|sample| {
            (0..3).all(|i| {
                (sample.specific_force[i] - force[i]).abs() < STILL
                    && (sample.angular_rate[i] - rate[i]).abs() * 5.0 < STILL
            })
        });
        let gravity = force.iter().map(|x| x * x).sum::<f64>().sqrt();
        is_still.then(|| Self { index, gravity, rate: rate.map(f64::to_degrees) })
    }
}

/// The median over parts, for each axis, of a function of the rate.
fn middle(parts: &[Part], of: impl Fn([f64; 3]) -> [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| median(&parts.iter().map(|part| of(part.rate)[i]).collect::<Vec<_>>()))
}

/// The axis whose zero moves farthest, if one moves.
fn moved(zeros: &[Zero]) -> Option<Finding> {
    let pairs =
        zeros.iter().enumerate().flat_map(|(k, a)| zeros[k + 1..].iter().map(move |b| (a, b)));
    let axes = pairs.flat_map(|(a, b)| (0..3).map(move |i| (a, b, i)));
    let by = |(a, b, i): &(&Zero, &Zero, usize)| (b.rate[*i] - a.rate[*i]).abs();
    let is_moved =
        |it: &(&Zero, &Zero, usize)| by(it) > MOVED + 3.0 * (it.0.apart[it.2] + it.1.apart[it.2]);
    let farthest = axes.filter(is_moved).max_by(|a, b| by(a).total_cmp(&by(b)))?;
    let (a, b, i) = farthest;
    Some(Finding::fault(
        "gyroscope's bias",
        Reason::Innovations,
        format!(
            "the gyroscope's zero moves: {} by {:.2} °/s between the standstills at {:.0} s and {:.0} s",
            ["x", "y", "z"][i],
            b.rate[i] - a.rate[i],
            a.t,
            b.t
        ),
        "directions and strides between them are off",
        "let the sensor warm up, or look at its supply",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a change of the zero is reported that occurs at once, by `by` °/s, while the foot walks between two
    /// standstills of 2 s.
    fn told(by: f64) -> bool {
        let sample = |k: u32| {
            let t = f64::from(k) * 0.01;
            let walks = (2.0..8.0).contains(&t);
            let swing = if walks { 3.0 * (6.0 * t).sin() } else { 0.002 * (40.0 * t).sin() };
            let zero = if t > 5.0 { by.to_radians() } else { 0.0 };
            Sample {
                time_us: u64::from(k) * 10_000,
                specific_force: [swing, 0.0, 9.8],
                angular_rate: [0.0, swing, 0.004 + zero],
            }
        };
        let samples: Vec<Sample> = (0..1000).map(sample).collect();
        check(&samples, 0.01).iter().any(Finding::is_fault)
    }

    #[test]
    fn a_zero_that_moves_between_standstills_is_told() {
        assert!(!told(0.0) && !told(0.3));
        assert!(told(1.0) && told(-2.0));
    }
}
