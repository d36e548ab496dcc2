//! How well the gyroscope explains what the accelerometer shows, at a supposed scale and with supposed axes.
//!
//! Between two moments of rest `a` and `b` the sensor turns and moves. Let `R(t)` be the turn from the body at `t` to the
//! body at `a`, integrated from the gyroscope, and `u` the measured direction of gravity's reaction. Two things must hold,
//! whatever the motion was:
//!
//! - the turn carries gravity along: `R(b) u(b) = u(a)`;
//! - the velocity is the same at both ends, so the mean of the turned specific force is gravity's reaction alone: `mean of
//!   R(t) f(t) = g u(a)`.
//!
//! The second one sees turns that end where they began, as a foot's do in each stride. Both are free of the
//! accelerometer's unit once its norm at rest is known, and the turn depends only on the product of the units of rate and
//! time: that product and the axes are what can be told.

use super::raw::Raw;
use super::rest::{Rest, Window, length_of};

/// The longest stretch between two moments of rest, s: over it a bias of 1 °/s turns by 10°.
const LONGEST: f64 = 10.0;
/// The longest short stretch, s: a stride. If there are at least `ENOUGH` short stretches, only these are used.
const SHORT: f64 = 2.5;
const ENOUGH: usize = 5;
/// Stretches that turn by less than this share of the liveliest ones tell little and are left out.
const LIVELY: f64 = 0.4;
/// Directions of gravity farther apart than `APART` belong to two moments even if there is only rest between them, rad;
/// directions closer than `SAME` belong to one moment.
const APART: f64 = 0.3;
const SAME: f64 = 0.03;
/// The largest numbers of stretches and of samples that are used, spread over the whole log.
const MOST_STRETCHES: usize = 48;
const MOST_SAMPLES: usize = 8_000;
/// A gap longer than this many usual steps excludes a stretch: the gyroscope did not see all of its motion.
const GAP: f64 = 8.0;

/// The axes of the gyroscope that are taken as the accelerometer's x, y and z, with their signs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Axes {
    pub(crate) from: [usize; 3],
    pub(crate) signs: [f64; 3],
}

impl Axes {
    /// The axes as they are.
    pub(crate) const SAME: Self = Self { from: [0, 1, 2], signs: [1.0; 3] };

    /// All 48 ways to swap and mirror the axes.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        const ORDERS: [[usize; 3]; 6] =
            [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        ORDERS.into_iter().flat_map(|from| {
            (0..8).map(move |bits: u32| {
                let sign = |axis: u32| if bits >> axis & 1 == 0 { 1.0 } else { -1.0 };
                Self { from, signs: [sign(0), sign(1), sign(2)] }
            })
        })
    }

    fn of(self, vector: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| self.signs[axis] * vector[self.from[axis]])
    }
}

/// Stretches of a log between moments of rest.
#[derive(Debug, Clone)]
pub(crate) struct Motion {
    stretches: Vec<Stretch>,
    /// The biases that are tried: the gyroscope's mean during rest, and zero. A foot that never stands still turns even
    /// in those moments, so that their mean is motion.
    biases: [[f64; 3]; 2],
}

#[derive(Debug, Clone)]
struct Stretch {
    /// For each step: the time since the sample before, in the log's own unit, the mean rate over it, and the specific
    /// force as a multiple of its norm at rest.
    steps: Vec<(f64, [f64; 3], [f64; 3])>,
    first: [f64; 3],
    last: [f64; 3],
    /// The integral of the norm of the bias-free rate.
    turned: f64,
}

impl Motion {
    /// The stretches of a log whose usual spacing is `usual` in its own unit and `step` in seconds.
    pub(crate) fn find(raw: &[Raw], rest: &Rest, usual: f64, step: f64) -> Self {
        let mut stretches = Vec::new();
        for (a, b) in ends(&rest.windows, (LONGEST / step) as usize) {
            let part = &raw[a.middle..=b.middle];
            if !part.windows(2).any(|pair| pair[1].time - pair[0].time > GAP * usual) {
                stretches.push(Stretch::new(part, rest, a.force, b.force));
            }
        }
        let is_short = |stretch: &Stretch| stretch.steps.len() as f64 * step <= SHORT;
        let most = high(stretches.iter().map(|stretch| stretch.turned));
        let most_of_short = high(
            stretches.iter().filter(|stretch| is_short(stretch)).map(|stretch| stretch.turned),
        );
        let is_lively =
            |stretch: &Stretch| is_short(stretch) && stretch.turned >= LIVELY * most_of_short;
        let lively = stretches.iter().filter(|stretch| is_lively(stretch)).count();
        if lively >= ENOUGH && most_of_short > LIVELY * most {
            stretches.retain(is_lively);
        } else {
            stretches.retain(|stretch| stretch.turned >= LIVELY * most);
        }
        let every = stretches.len().div_ceil(MOST_STRETCHES).max(1);
        let samples: usize =
            stretches.iter().step_by(every).map(|stretch| stretch.steps.len()).sum();
        let every = every * samples.div_ceil(MOST_SAMPLES).max(1);
        let stretches = stretches.into_iter().step_by(every).collect();
        Self { stretches, biases: [rest.bias, [0.0; 3]] }
    }

    /// The number of stretches.
    pub(crate) fn count(&self) -> usize {
        self.stretches.len()
    }

    /// The disagreement if the product of the units of rate and time is `scale`.
    ///
    /// 0 is perfect; 0.1 is 6° or a tenth of gravity. It is the mean over the better half of the stretches, because the
    /// other half may contain slips and impacts.
    pub(crate) fn error(&self, scale: f64, axes: Axes) -> f64 {
        let [rest, none] = self.biases.map(|bias| self.error_with(bias, scale, axes));
        rest.min(none)
    }

    fn error_with(&self, bias: [f64; 3], scale: f64, axes: Axes) -> f64 {
        let error = |stretch: &Stretch| stretch.error(bias, scale, axes).min(1.0);
        let mut errors: Vec<_> = self.stretches.iter().map(error).collect();
        errors.sort_by(f64::total_cmp);
        errors.truncate(errors.len().div_ceil(2));
        errors.iter().sum::<f64>() / errors.len() as f64
    }
}

/// Pairs of moments of rest between which the sensor moved or turned.
fn ends(windows: &[Window], longest: usize) -> Vec<(Window, Window)> {
    let mut ends = Vec::new();
    let mut start: Option<Window> = None;
    let mut has_moved = false;
    for window in windows {
        if !window.is_still {
            has_moved = true;
            continue;
        }
        let turned = start.map_or(0.0, |start| angle(start.force, window.force));
        match start {
            Some(start) if window.middle - start.middle > longest => {}
            Some(start) if has_moved || turned > APART => ends.push((start, *window)),
            // A slow turn goes on; after a rest the stretch begins at the end of the rest.
            Some(_) if turned > SAME => continue,
            _ => {}
        }
        (start, has_moved) = (Some(*window), false);
    }
    ends
}

/// The 90th percentile.
fn high(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<_> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() * 9 / 10).copied().unwrap_or(0.0)
}

impl Stretch {
    fn new(part: &[Raw], rest: &Rest, first: [f64; 3], last: [f64; 3]) -> Self {
        let mut turned = 0.0;
        let steps = part.windows(2).map(|pair| {
            let time = pair[1].time - pair[0].time;
            let rate: [f64; 3] =
                std::array::from_fn(|axis| 0.5 * (pair[0].rate[axis] + pair[1].rate[axis]));
            let force = std::array::from_fn(|axis| {
                0.5 * (pair[0].force[axis] + pair[1].force[axis]) / rest.norm
            });
            turned += length_of(difference(rate, rest.bias)) * time;
            (time, rate, force)
        });
        let steps = steps.collect();
        Self { steps, first: unit(first), last: unit(last), turned }
    }

    fn error(&self, bias: [f64; 3], scale: f64, axes: Axes) -> f64 {
        // The columns of the rotation from the body at the end to the body at the start.
        let mut turn = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let (mut sum, mut duration) = ([0.0; 3], 0.0);
        for &(time, rate, force) in &self.steps {
            let half = turn_of(axes.of(difference(rate, bias)).map(|x| 0.5 * x * scale * time));
            turn = half.map(|column| apply(turn, column));
            let force = apply(turn, force);
            turn = half.map(|column| apply(turn, column));
            for axis in 0..3 {
                sum[axis] += force[axis] * time;
            }
            duration += time;
        }
        let carried = apply(turn, self.last);
        let mut square = 0.0;
        for axis in 0..3 {
            square += (carried[axis] - self.first[axis]).powi(2);
            square += (sum[axis] / duration - self.first[axis]).powi(2);
        }
        if square.is_finite() { square.sqrt() } else { 1.0 }
    }
}

/// The columns of the rotation by a rotation vector.
fn turn_of([x, y, z]: [f64; 3]) -> [[f64; 3]; 3] {
    let angle = length_of([x, y, z]);
    let (sine, cosine) = angle.sin_cos();
    // Rodrigues: 1 + s·[v] + c·[v]².
    let (s, c) =
        if angle > 1e-6 { (sine / angle, (1.0 - cosine) / (angle * angle)) } else { (1.0, 0.5) };
    [
        [1.0 - c * (y * y + z * z), s * z + c * x * y, -s * y + c * x * z],
        [-s * z + c * x * y, 1.0 - c * (x * x + z * z), s * x + c * y * z],
        [s * y + c * x * z, -s * x + c * y * z, 1.0 - c * (x * x + y * y)],
    ]
}

fn apply(columns: [[f64; 3]; 3], vector: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|row| (0..3).map(|i| columns[i][row] * vector[i]).sum())
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn unit(vector: [f64; 3]) -> [f64; 3] {
    let norm = length_of(vector);
    vector.map(|x| x / norm)
}

/// The angle between two directions, rad.
pub(super) fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let (a, b) = (unit(a), unit(b));
    let cosine: f64 = (0..3).map(|i| a[i] * b[i]).sum();
    cosine.clamp(-1.0, 1.0).acos()
}
