//! Calibration of the sensor from the positions and turns of a log.

use std::ops::Range;

use kestirim_import::inertial::{Stand, stands};
use kestirim_imu_calibration::{
    AccelerometerFit, AccelerometerModel, Calibration, Error, Gyroscope, GyroscopeFit,
    GyroscopeModel, Pose, Poses, Side, Triad, Turn,
};
use nalgebra::SVector;

use crate::metrics::STANDARD_GRAVITY;
use crate::systems::pedestrian::Sample;
use crate::systems::pedestrian::recording::calibration::Sigmas;

/// The minimum time that a position is held still, without the moments in which a hand lets go (s).
pub(super) const SHORTEST_S: f64 = 1.0;
/// The time for which a person is asked to hold a position (s).
pub(super) const HOLD_S: f64 = 2.0;
/// The longest turn that is used (s), as the bias drifts meanwhile.
const LONGEST_TURN_S: f64 = 20.0;
/// The maximum number of positions that are used.
const MOST_POSES: usize = 256;
/// The error of a consumer accelerometer's mean from one position to another, in m/s²: one mg.
const POSE_NOISE: f64 = 0.01;
/// The error of a consumer gyroscope's mean from one position to another, in rad/s: 0.03 °/s.
const RATE_NOISE: f64 = 0.0005;
/// The error of a turn apart from scale and misalignment, in rad: 0.2°.
const TURN_NOISE: f64 = 0.003;
/// The smallest number of samples in a row at the end of a range.
const ENOUGH: usize = 3;
/// The smallest jump to the end of a range, in steps of the rate.
const JUMP: f64 = 2.5;
/// The smallest rate at which a gyroscope's range may end, in rad/s.
const FAST: f64 = 1.0;
/// The number of times that the turns are integrated: each pass leaves a hundredth of the error.
const PASSES: usize = 4;

/// The result of a calibration.
#[derive(Debug, Clone)]
pub(super) struct Found {
    pub(super) calibration: Calibration<f64>,
    pub(super) sigmas: [Sigmas; 2],
    pub(super) poses: usize,
    pub(super) turns: usize,
    /// The number of turns that are left out, as an axis reached the end of its range.
    pub(super) clipped: usize,
    pub(super) accelerometer: AccelerometerModel,
    /// The model of the gyroscope; `None` if the turns determine only the bias.
    pub(super) gyroscope: Option<GyroscopeModel>,
    /// The deviation of corrected positions from gravity (m/s²).
    pub(super) residual: f64,
    /// The error of the direction of gravity after corrected turns (rad).
    pub(super) astray: Option<f64>,
    /// The sides that were not shown.
    pub(super) missing: Vec<Side>,
}

/// The reason why there is no calibration, and the sides that were not shown.
#[derive(Debug, Clone)]
pub(super) struct Refusal {
    pub(super) error: Error,
    pub(super) poses: usize,
    pub(super) missing: Vec<Side>,
}

/// Finds the positions and turns in a log, and calibrates the sensor from them.
pub(super) fn find(samples: &[Sample]) -> Result<Found, Refusal> {
    let stands = stands(samples, SHORTEST_S);
    let mut poses = Poses::<f64, MOST_POSES>::new();
    for stand in stands.iter().take(MOST_POSES) {
        // The measurements are finite and show gravity.
        let _ = pose(&samples[stand.samples.clone()]).and_then(|pose| poses.add(pose));
    }
    let missing: Vec<_> = poses.missing().collect();
    let count = poses.count();
    let refused = |error| Refusal { error, poses: count, missing: missing.clone() };
    let accelerometer = poses.accelerometer(STANDARD_GRAVITY, POSE_NOISE).map_err(&refused)?;
    let bias = poses.gyroscope_bias(RATE_NOISE).map_err(&refused)?;
    let start = Triad { offset: bias.bias, ..Triad::identity() };
    let (turned, turns, clipped) = turned(samples, &stands, &accelerometer, start);
    let of_gyroscope = Sigmas {
        offset: bias.sigma.map(Some),
        matrix: turned.as_ref().map(|fit| fit.matrix_sigma).unwrap_or_default(),
    };
    let of_accelerometer =
        Sigmas { offset: accelerometer.offset_sigma.map(Some), matrix: accelerometer.matrix_sigma };
    Ok(Found {
        calibration: Calibration {
            accelerometer: accelerometer.triad,
            gyroscope: turned.as_ref().map_or(start, |fit| fit.triad),
        },
        sigmas: [of_accelerometer, of_gyroscope],
        poses: poses.count(),
        turns,
        clipped,
        accelerometer: accelerometer.model,
        gyroscope: turned.as_ref().map(|fit| fit.model),
        residual: accelerometer.residual,
        astray: turned.as_ref().map(|fit| fit.residual),
        missing: poses.missing().collect(),
    })
}

fn pose(samples: &[Sample]) -> Result<Pose<f64>, Error> {
    let mut pose = Pose::new();
    for sample in samples {
        pose.push(&SVector::from(sample.specific_force), &SVector::from(sample.angular_rate))?;
    }
    Ok(pose)
}

/// The fit of the gyroscope, if the turns determine it, the number of turns, and that of turns in which an axis was cut off.
fn turned(
    samples: &[Sample],
    stands: &[Stand],
    accelerometer: &AccelerometerFit<f64>,
    start: Triad<f64>,
) -> (Option<GyroscopeFit<f64>>, usize, usize) {
    let rails = [0, 1, 2].map(|axis| Rails::of(samples, axis));
    let mut pairs: Vec<_> = stands.windows(2).collect();
    let all = pairs.len();
    pairs.retain(|pair| {
        let between = samples.get(pair[0].samples.end..pair[1].samples.start);
        let between = between.unwrap_or_default();
        rails.iter().all(|rails| !rails.cut(between))
    });
    let clipped = all - pairs.len();
    let mut triad = start;
    let mut result = (None, 0, clipped);
    for _ in 0..PASSES {
        let Ok(mut gyroscope) = Gyroscope::new(triad) else { break };
        let mut turns = 0;
        for pair in &pairs {
            let added = add(&mut gyroscope, triad, samples, pair, accelerometer);
            turns += usize::from(added.is_some());
        }
        result.1 = turns;
        match gyroscope.solve(TURN_NOISE) {
            Ok(fit) => (triad, result.0) = (fit.triad, Some(fit)),
            Err(_) => return (None, turns, clipped),
        }
    }
    result
}

/// The rates of an axis at which its range may end.
struct Rails {
    axis: usize,
    /// The smallest and the largest rate (rad/s).
    ends: [f64; 2],
    /// The smallest change of the rate from one sample to the next (rad/s): a step of the sensor, or of its printing.
    step: f64,
}

impl Rails {
    fn of(samples: &[Sample], axis: usize) -> Self {
        let rate = |sample: &Sample| sample.angular_rate[axis];
        let most = samples.iter().map(rate).fold(f64::NEG_INFINITY, f64::max);
        let least = samples.iter().map(rate).fold(f64::INFINITY, f64::min);
        let changes = samples.windows(2).map(|pair| (rate(&pair[1]) - rate(&pair[0])).abs());
        let step = changes.filter(|change| *change > 0.0).fold(f64::INFINITY, f64::min);
        Self { axis, ends: [least, most], step }
    }

    /// Whether a turn was cut off at an end: the rate stays there for some samples, and comes there in a jump. (That of a slow
    /// reversal stays at its largest value, too, but comes there step by step.)
    fn cut(&self, turn: &[Sample]) -> bool {
        let rates: Vec<f64> = turn.iter().map(|sample| sample.angular_rate[self.axis]).collect();
        self.ends.iter().filter(|end| end.abs() > FAST).any(|end| {
            let mut from = 0;
            let mut runs = rates.chunk_by(|a, b| (a == end) == (b == end)).map(|run| {
                from += run.len();
                from - run.len()..from
            });
            runs.any(|run| {
                let beside = [run.start.checked_sub(1), Some(run.end)];
                let beside = beside.into_iter().flatten().filter_map(|place| rates.get(place));
                let jump = beside.map(|rate| (rate - end).abs()).fold(0.0, f64::max);
                rates.get(run.start) == Some(end) && run.len() >= ENOUGH && jump > JUMP * self.step
            })
        })
    }
}

/// Adds the turn between two stands, if all of it was recorded.
fn add(
    gyroscope: &mut Gyroscope<f64>,
    triad: Triad<f64>,
    samples: &[Sample],
    stands: &[Stand],
    accelerometer: &AccelerometerFit<f64>,
) -> Option<()> {
    let [from, to] = stands else { return None };
    let force = |range: &Range<usize>| {
        let pose = pose(samples.get(range.clone())?).ok()?;
        Some(accelerometer.triad.apply(&pose.specific_force))
    };
    let between = samples.get(middle(&from.samples)..=middle(&to.samples))?;
    let moving = samples.get(from.samples.end)?.time_us..samples.get(to.samples.start)?.time_us;
    if (moving.end.checked_sub(moving.start)?) as f64 * 1e-6 > LONGEST_TURN_S {
        return None;
    }
    let mut turn = Turn::new(triad).ok()?;
    for pair in between.windows(2) {
        let rate = SVector::from(pair[0].angular_rate) + SVector::from(pair[1].angular_rate);
        let interval = pair[1].time_us.checked_sub(pair[0].time_us)? as f64 * 1e-6;
        turn.push(&(rate * 0.5), interval).ok()?;
    }
    gyroscope.add(&turn, &force(&from.samples)?, &force(&to.samples)?).ok()
}

/// The middle of a stand. Turns are taken from middle to middle, as a hand that settles within a stand is seen by both
/// sensors.
fn middle(range: &Range<usize>) -> usize {
    range.start.midpoint(range.end)
}
