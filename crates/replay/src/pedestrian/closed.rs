//! Closing of walks that ended where they began.

use kestirim_pedestrian::PathUncertainty;
use nalgebra::{Matrix2, Vector2};

use super::path::{Path, PathErrors};
use super::{Stride, Walk};

/// Standard deviation of the distance between start and end of a walk that ended where it began, m.
const PUT_BACK: f64 = 0.1;
/// The χ² of three degrees of freedom that a closed walk exceeds once in a thousand cases.
const UNLIKELY: f64 = 16.3;
/// The number of heading rates that are tried first, to either side, and the largest of them in standard deviations.
const TRIED: (i32, f64) = (40, 4.0);

impl Walk {
    /// Closes the path: it ends where it began, in the plane and in height.
    ///
    /// The kinds of errors of a path are known ([`PathUncertainty`]): a constant rate of the heading, a scale, an error
    /// of each stride. The most likely errors that close the path are removed; standard deviations are those that
    /// remain.
    ///
    /// # Errors
    /// A sentence if there is no stride, or if these errors do not explain the distance between end and start: the walk
    /// then stays as it was.
    pub fn close(&mut self) -> Result<(), String> {
        let Some(last) = self.strides.last() else {
            return Err("the path is not closed: there is no stride".to_owned());
        };
        let start = self.start();
        let path = Path::of(self);
        let prior = Prior::of(self);
        let (rate, scale, unlikely) = path.closing(&prior);
        let (gap_m, rise_m) = (path.end(0.0, 0.0).norm(), last.position[2] - start[2]);
        if unlikely + rise_m * rise_m / (prior.heights + PUT_BACK * PUT_BACK) > UNLIKELY {
            return Err(format!(
                "the path is not closed: its end is {gap_m:.2} m from its start and {rise_m:+.2} m above it, \
                 which errors of this sensor do not explain"
            ));
        }
        self.turn_back(rate);
        self.shorten(scale);
        // The remaining gap is distributed equally over the strides.
        let end = self.strides.last().map_or(start, |stride| stride.position);
        let taken = prior.shares_of_a_stride();
        let taken = [0, 1, 2].map(|axis| -taken[axis] * (end[axis] - start[axis]));
        let strides = 1..=self.strides.len();
        self.displace(&strides.map(|count| taken.map(|of| count as f64 * of)).collect::<Vec<_>>());
        // A lost heading is not a constant rate, so that then only the end is known better.
        let (left, last) = (path.remaining(&prior, rate, scale), self.strides.len() - 1);
        let is_unseen = self.strides.iter().any(Stride::is_unseen);
        for (at, (stride, sigma_m)) in self.strides.iter_mut().zip(left).enumerate() {
            if !is_unseen || at == last {
                stride.sigma_m = sigma_m;
            }
        }
        self.gap_m = Some(gap_m);
        Ok(())
    }
}

/// Variances of the errors of a path, before it is known that it is closed.
struct Prior {
    /// Standard deviation of the heading's rate, rad/s.
    rate: f64,
    /// Standard deviation of the scale.
    scale: f64,
    /// Variance of the sum of all strides' own errors, for each axis, m².
    strides: f64,
    /// Variance of the sum of all height errors, m².
    heights: f64,
    /// Variance of a stride's height, m²: of its own error, and (`rise`) of the error common to all strides.
    height: f64,
    rise: f64,
    count: f64,
}

impl Prior {
    fn of(walk: &Walk) -> Self {
        let (left, count) = (PathErrors::of(walk), walk.strides.len() as f64);
        let class = kestirim_pedestrian::SensorClass::from(walk.sensor);
        let rise = class.height_drift::<f64>().powi(2);
        let height = PathUncertainty::<f64>::HEIGHT.powi(2);
        Self {
            rate: left.rate,
            scale: left.scale,
            strides: count * left.stride.powi(2),
            heights: count * (height + count * rise),
            height,
            rise,
            count,
        }
    }

    /// The share of the remaining gap that each stride takes, in the plane and in height.
    fn shares_of_a_stride(&self) -> [f64; 3] {
        let of = |variance: f64| variance / (variance + PUT_BACK * PUT_BACK) / self.count.max(1.0);
        [self.strides, self.strides, self.heights].map(of)
    }
}

impl Path {
    /// The χ² of these errors.
    fn unlikeliness(&self, prior: &Prior, [rate, scale]: [f64; 2]) -> f64 {
        let of_the_end =
            self.end(rate, scale).norm_squared() / (prior.strides + PUT_BACK * PUT_BACK);
        (rate / prior.rate).powi(2) + (scale / prior.scale).powi(2) + of_the_end
    }

    /// The most likely rate and scale that close the path, and their χ².
    fn closing(&self, prior: &Prior) -> (f64, f64, f64) {
        let (count, furthest) = TRIED;
        let tried =
            (-count..=count).map(|k| f64::from(k) / f64::from(count) * furthest * prior.rate);
        let unlikely = |rate: &f64| self.unlikeliness(prior, [*rate, 0.0]);
        let begin = tried.min_by(|a, b| unlikely(a).total_cmp(&unlikely(b))).unwrap_or(0.0);
        let mut found = Vector2::new(begin, 0.0);
        let weights =
            Matrix2::from_diagonal(&Vector2::new(prior.rate.powi(-2), prior.scale.powi(-2)));
        for _ in 0..20 {
            let Some((end, slope)) = self.walked(found.x, found.y).last() else { break };
            let weight = 1.0 / (prior.strides + PUT_BACK * PUT_BACK);
            let information = weights + slope.transpose() * slope * weight;
            let gradient = weights * found + slope.transpose() * end * weight;
            let Some(inverse) = information.try_inverse() else { break };
            found -= inverse * gradient;
        }
        (found.x, found.y, self.unlikeliness(prior, [found.x, found.y]))
    }

    /// Standard deviations after each stride, m, given that the path is closed.
    fn remaining(&self, prior: &Prior, rate: f64, scale: f64) -> Vec<[f64; 3]> {
        let variances =
            Matrix2::from_diagonal(&Vector2::new(prior.rate.powi(2), prior.scale.powi(2)));
        let Some((_, end)) = self.walked(rate, scale).last() else { return Vec::new() };
        let own = prior.strides / prior.count;
        let known = PUT_BACK * PUT_BACK;
        let gap = end * variances * end.transpose() + Matrix2::identity() * (prior.strides + known);
        let inverse = gap.try_inverse().unwrap_or_else(Matrix2::zeros);
        let after = |(index, (_, slope)): (usize, (Vector2<f64>, Matrix2<f64>))| {
            let strides = (index + 1) as f64;
            let noise = Matrix2::identity() * (strides * own);
            let with_end = slope * variances * end.transpose() + noise;
            let all = slope * variances * slope.transpose() + noise;
            let left = all - with_end * inverse * with_end.transpose();
            let with_last = strides * (prior.height + prior.count * prior.rise);
            let z = strides * (prior.height + strides * prior.rise);
            let z = z - with_last * with_last / (prior.heights + known);
            [left[(0, 0)], left[(1, 1)], z].map(|variance| variance.max(0.0).sqrt())
        };
        self.walked(rate, scale).enumerate().map(after).collect()
    }
}
