//! A walked path step by step: the effect of its errors, and their correction.

use kestirim_pedestrian::PathUncertainty;
use nalgebra::{Matrix2, Rotation2, Vector2};

use super::{Stride, Walk};

/// The steps from stance to stance, with the time of each after the start, s.
pub(super) struct Path {
    start_us: u64,
    pub(super) steps: Vec<(f64, Vector2<f64>)>,
}

/// Standard deviations of the errors that remain in a path in the plane ([`PathUncertainty`]).
#[derive(Debug, Clone, Copy)]
pub(super) struct PathErrors {
    /// Standard deviation of the heading's rate, rad/s.
    pub(super) rate: f64,
    /// Standard deviation of the scale.
    pub(super) scale: f64,
    /// Standard deviation of each stride's own error, for each axis, m.
    pub(super) stride: f64,
}

impl PathErrors {
    /// The errors for the class of the sensor, or those that the other foot and right angles left.
    pub(super) fn of(walk: &Walk) -> Self {
        let class = kestirim_pedestrian::SensorClass::from(walk.sensor);
        let off = walk.strides.last().map_or(0.0, |stride| stride.gravity_off);
        let mut left = Self {
            rate: class.heading_rate(),
            scale: PathUncertainty::scale(class, off),
            stride: PathUncertainty::<f64>::FOOTPRINT,
        };
        if let Some(feet) = walk.both_feet {
            (left.rate, left.stride) = (feet.rate_sigma, feet.stride_sigma);
        }
        if let Some(angles) = walk.right_angles {
            left.rate = angles.rate_sigma;
        }
        left
    }
}

impl Path {
    /// The steps of a walk. The time of a step is the mean over its displacement: a pause before or after it turns no
    /// step.
    pub(super) fn of(walk: &Walk) -> Self {
        let mut pairs = walk.track.windows(2).peekable();
        let start_us = walk.track.first().map_or(0, |point| point.time_us);
        let mut path = Self { start_us, steps: Vec::new() };
        let step = |stride: &Stride| {
            let (mut step, mut timed) = (Vector2::zeros(), Vector2::zeros());
            while let Some([a, b]) = pairs.next_if(|pair| pair[1].time_us <= stride.time_us) {
                let [from, to] = [a, b].map(|point| Vector2::from(point.horizontal()));
                step += to - from;
                timed += (to - from) * path.seconds(b.time_us);
            }
            let length = step.norm_squared();
            (if length > 0.0 { timed.dot(&step) / length } else { 0.0 }, step)
        };
        path.steps = walk.strides.iter().map(step).collect();
        path
    }

    /// The time after the start, s.
    pub(super) fn seconds(&self, time_us: u64) -> f64 {
        time_us.saturating_sub(self.start_us) as f64 * 1e-6
    }

    /// The path after each stride, turned back at a rate and shortened by a scale, and its derivatives with respect to
    /// both.
    pub(super) fn walked(
        &self,
        rate: f64,
        scale: f64,
    ) -> impl Iterator<Item = (Vector2<f64>, Matrix2<f64>)> {
        let (mut sum, mut turned) = (Vector2::zeros(), Vector2::zeros());
        self.steps.iter().map(move |(seconds, step)| {
            let step = Rotation2::new(-rate * seconds) * step;
            sum += step;
            turned += Vector2::new(step.y, -step.x) * *seconds;
            let place = sum * (1.0 - scale);
            (place, Matrix2::from_columns(&[turned * (1.0 - scale), -sum]))
        })
    }

    pub(super) fn end(&self, rate: f64, scale: f64) -> Vector2<f64> {
        self.walked(rate, scale).last().map_or_else(Vector2::zeros, |(place, _)| place)
    }
}

impl Walk {
    /// The start of the path, m.
    pub(super) fn start(&self) -> [f64; 3] {
        self.track.first().map_or([0.0; 3], |point| point.position)
    }

    /// Shortens the path by a scale, in the plane.
    pub(super) fn shorten(&mut self, scale: f64) {
        let start = self.start();
        let shorter = |[x, y, z]: [f64; 3]| {
            [
                start[0] + (x - start[0]) * (1.0 - scale),
                start[1] + (y - start[1]) * (1.0 - scale),
                z,
            ]
        };
        self.track.iter_mut().for_each(|point| point.position = shorter(point.position));
        for stride in &mut self.strides {
            stride.position = shorter(stride.position);
            stride.length_m *= 1.0 - scale;
        }
        self.path_length_m *= 1.0 - scale;
    }

    /// Moves each footprint by the given displacement, m, and the track between two of them where the foot moves.
    pub(super) fn displace(&mut self, by: &[[f64; 3]]) {
        let start = self.start();
        let (mut done, mut from) = (0, start);
        for point in &mut self.track {
            while let Some(stride) = self.strides.get(done).filter(|it| it.time_us < point.time_us)
            {
                (done, from) = (done + 1, stride.position);
            }
            let way = |to: [f64; 3]| (to[0] - from[0]).hypot(to[1] - from[1]);
            let share = self.strides.get(done).map_or(0.0, |stride| {
                let length_m = way(stride.position);
                if length_m > 0.0 { (way(point.position) / length_m).min(1.0) } else { 1.0 }
            });
            let before = done.checked_sub(1).and_then(|last| by.get(last)).copied();
            let before = before.unwrap_or_default();
            let after = by.get(done).copied().unwrap_or(before);
            point.position = [0, 1, 2].map(|axis| {
                point.position[axis] + before[axis] + share * (after[axis] - before[axis])
            });
        }
        for (stride, by) in self.strides.iter_mut().zip(by) {
            stride.position = [0, 1, 2].map(|axis| stride.position[axis] + by[axis]);
        }
        if let Some([x, y, _]) = self.track.last().map(|point| point.position) {
            self.closure_m = (x - start[0]).hypot(y - start[1]);
        }
    }
}
