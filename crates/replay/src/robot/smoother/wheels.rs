//! The motion of a robot on wheels, with its heading and the errors of the wheels.

use kestirim_uwb_tracker::wheel_noise as noise;
use nalgebra::{DVector, SMatrix, SVector};

use super::super::{Event, Wheels};
use super::Tracked;
use super::knots::{Knot, Knots};
use super::problem::Motion;
use crate::chain::Tie;

/// The motion model, with position and (c, s) = k (cos θ, sin θ) for the wheels' scale k and the heading θ: the wheels'
/// motion is linear in those, so that nothing need be known of the heading to begin with. The gain and drift (rad/s) of
/// the turns are parameters.
#[derive(Debug, Clone)]
pub(super) struct Driven {
    /// The steps of the wheels from each knot to the next.
    steps: Vec<Vec<Step>>,
    /// The sign of turns: 1 or −1.
    side: f64,
}

/// A step of the wheels.
#[derive(Debug, Clone, Copy)]
enum Step {
    /// The wheels counted a way, m, and a turn, rad, in a time, s.
    Counted { way: f64, turn: f64, interval: f64 },
    /// The wheels were silent for a time, s, with this speed before it, m/s.
    Unknown { speed: f64, interval: f64 },
}

/// The variances that any step adds, of a coordinate, m², and of c and s, so that no tie is rigid.
const LEAST_NOISE: [f64; 2] = [1e-8, 1e-10];
/// The rate at which the variance of the heading grows, rad²/s: the drift is not quite constant.
const HEADING_WALK: f64 = 1e-8;
/// The prior standard deviation of the drift, rad/s.
const DRIFT_SIGMA: f64 = 0.01 * noise::DRIFT_SIGMA;

impl Driven {
    pub(super) fn new(parts: &[Tracked<'_>], knots: &Knots, side: f64) -> Self {
        let of_part = |Tracked { events, .. }: &Tracked<'_>| {
            let is_plausible = |rate: f64| rate.is_finite() && rate.abs() <= noise::LARGEST_SPEED;
            let mut samples: Vec<Wheels> = Vec::new();
            for event in *events {
                let Event::Wheels(wheels) = event else { continue };
                let is_later = samples.last().is_none_or(|last| last.time_us < wheels.time_us);
                if is_later && is_plausible(wheels.speed) && is_plausible(wheels.turn_rate) {
                    samples.push(*wheels);
                }
            }
            samples
        };
        let samples: Vec<_> = parts.iter().map(of_part).collect();
        let steps = knots.points.windows(2).map(|pair| {
            let times = [pair[0].epoch.time_us, pair[1].epoch.time_us];
            let of_part =
                if pair[0].part == pair[1].part { &samples[pair[0].part][..] } else { &[] };
            steps(of_part, times)
        });
        Self { steps: steps.collect(), side }
    }
}

/// The steps of the wheels between two times. A sample tells the motion since the previous one.
fn steps(samples: &[Wheels], [begin_us, end_us]: [i64; 2]) -> Vec<Step> {
    let mut steps = Vec::new();
    let (mut now_us, mut next) =
        (begin_us, samples.partition_point(|sample| sample.time_us <= begin_us));
    while now_us < end_us {
        let sample = samples.get(next);
        let until_us = sample.map_or(end_us, |sample| sample.time_us).clamp(now_us, end_us);
        let interval = (until_us - now_us) as f64 * 1e-6;
        let counted = sample.filter(|sample| sample.time_us.abs_diff(now_us) <= noise::FRESH_US);
        steps.push(if let Some(Wheels { speed, turn_rate, .. }) = counted {
            Step::Counted { way: speed * interval, turn: turn_rate * interval, interval }
        } else {
            let last = next.checked_sub(1).and_then(|last| samples.get(last));
            Step::Unknown { speed: last.map_or(0.0, |sample| sample.speed), interval }
        });
        (now_us, next) = (until_us, next + 1);
    }
    steps
}

/// The sum of several steps, in the axes of the first.
#[derive(Debug, Clone, Copy, Default)]
struct Way {
    /// The motion ahead and to the left, m, and (`by`) its derivatives with respect to gain and drift.
    moved: [f64; 2],
    by: [[f64; 2]; 2],
    /// The turns as counted, rad, and (`elapsed`) the time for which they were counted, s.
    turned: f64,
    elapsed: f64,
    /// Variances of a coordinate, m², and of the heading.
    noise: [f64; 2],
}

impl Way {
    fn of(steps: &[Step], gain: f64, drift: f64) -> Self {
        let mut all = Self { noise: LEAST_NOISE, ..Self::default() };
        for step in steps {
            match *step {
                Step::Counted { way, turn, interval } => {
                    let (turned, elapsed) = (all.turned + 0.5 * turn, all.elapsed + 0.5 * interval);
                    let (sine, cosine) = (gain * turned + drift * elapsed).sin_cos();
                    let step = [way * cosine, way * sine];
                    for axis in 0..2 {
                        all.moved[axis] += step[axis];
                    }
                    for (by, angle) in all.by.iter_mut().zip([turned, elapsed]) {
                        by[0] -= step[1] * angle;
                        by[1] += step[0] * angle;
                    }
                    all.turned += turn;
                    all.elapsed += interval;
                    let (way, turn) = (way.abs(), turn.abs());
                    all.noise[0] += way * noise::SLIP;
                    all.noise[1] += way * noise::WAY_TO_HEADING + turn * noise::TURN_TO_HEADING;
                    all.noise[1] += interval * HEADING_WALK;
                }
                Step::Unknown { speed, interval } => {
                    let square = (speed * speed).max(noise::UNKNOWN_SPEED.powi(2));
                    all.noise[0] += interval * square * noise::UNKNOWN_TIME;
                    all.noise[1] += interval * noise::UNKNOWN_TURN;
                }
            }
        }
        all
    }
}

impl Motion<4> for Driven {
    fn begin(&self, knot: &Knot) -> SVector<f64, 4> {
        SVector::from([knot.begin[0], knot.begin[1], 0.0, 0.0])
    }

    fn prior(&self) -> SVector<f64, 4> {
        // A scale of about one, in any direction.
        SVector::from([0.0, 0.0, 1.0, 1.0])
    }

    fn parameters(&self) -> Vec<[f64; 2]> {
        vec![[self.side, noise::GAIN_SIGMA], [0.0, DRIFT_SIGMA]]
    }

    fn tie(
        &self,
        index: usize,
        _: f64,
        [before, after]: [&SVector<f64, 4>; 2],
        own: &DVector<f64>,
    ) -> Tie<4, 4> {
        let (gain, drift) = (own[0], own[1]);
        let way = Way::of(&self.steps[index], gain, drift);
        let (sine, cosine) = (gain * way.turned + drift * way.elapsed).sin_cos();
        let ([c, s], [ahead, left]) = ([before[2], before[3]], way.moved);
        let turned = |[ahead, left]: [f64; 2]| [c * ahead - s * left, s * ahead + c * left];
        let (moved, headed) = (turned(way.moved), turned([cosine, sine]));
        let residual = SVector::from([
            after[0] - before[0] - moved[0],
            after[1] - before[1] - moved[1],
            after[2] - headed[0],
            after[3] - headed[1],
        ]);
        let [position, heading] = way.noise.map(|variance| variance.sqrt().recip());
        let weight = SMatrix::from_diagonal(&SVector::from([position, position, heading, heading]));
        #[rustfmt::skip]
        let transition = SMatrix::<f64, 4, 4>::new(
            1.0, 0.0, ahead, -left,
            0.0, 1.0, left, ahead,
            0.0, 0.0, cosine, -sine,
            0.0, 0.0, sine, cosine,
        );
        let angles = [way.turned, way.elapsed].into_iter().zip(way.by).enumerate();
        let shared = angles.map(|(parameter, (angle, by))| {
            let (moved, headed) = (turned(by), turned([-sine * angle, cosine * angle]));
            let column = SVector::from([-moved[0], -moved[1], -headed[0], -headed[1]]);
            (parameter, weight * column)
        });
        Tie {
            residual: weight * residual,
            before: -weight * transition,
            after: weight,
            shared: shared.collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_differences() {
        let steps = vec![
            Step::Counted { way: 0.3, turn: 0.2, interval: 0.2 },
            Step::Unknown { speed: 0.4, interval: 0.1 },
            Step::Counted { way: 0.1, turn: -0.5, interval: 0.3 },
        ];
        let motion = Driven { steps: vec![steps], side: 1.0 };
        let (before, after) =
            (SVector::from([1.0, 2.0, 0.8, -0.5]), SVector::from([1.3, 2.2, 0.7, -0.6]));
        let own = DVector::from_vec(vec![1.1, 0.05]);
        let tie = motion.tie(0, 0.6, [&before, &after], &own);
        let step = 1e-6;
        let near = |found: SVector<f64, 4>, residual: SVector<f64, 4>| {
            let expected = (residual - tie.residual) / step;
            assert!(
                (found - expected).amax() < 1e-3 * (1.0 + expected.amax()),
                "{found} {expected}"
            );
        };
        for i in 0..4 {
            let (mut earlier, mut later) = (before, after);
            earlier[i] += step;
            later[i] += step;
            let column = tie.before.column(i).into_owned();
            near(column, motion.tie(0, 0.6, [&earlier, &after], &own).residual);
            let column = tie.after.column(i).into_owned();
            near(column, motion.tie(0, 0.6, [&before, &later], &own).residual);
        }
        for (parameter, column) in &tie.shared {
            let mut other = own.clone();
            other[*parameter] += step;
            near(*column, motion.tie(0, 0.6, [&before, &after], &other).residual);
        }
    }

    #[test]
    fn a_sample_says_what_was_since_the_one_before() {
        let sample = |time_us, speed| Wheels { time_us, speed, turn_rate: 0.0 };
        let samples = [sample(0, 9.0), sample(1_000_000, 1.0), sample(2_000_000, 2.0)];
        let ways = |times| -> f64 {
            let of = |step: &Step| if let Step::Counted { way, .. } = step { *way } else { 0.0 };
            steps(&samples, times).iter().map(of).sum()
        };
        assert!((ways([500_000, 1_500_000]) - 1.5).abs() < 1e-9);
        assert_eq!(ways([2_000_000, 3_000_000]), 0.0, "nobody knows");
    }
}
