//! Two sensors on one walk, one on each foot or both on one foot: their paths stay together.

mod meeting;
mod problem;

use nalgebra::Matrix2;

use self::problem::{OWN, Problem, Solved};
use super::path::PathErrors;
use super::{Stride, Walk, position_at};

/// The fewest meetings from which a correction is computed.
const FEWEST: usize = 8;
/// The root mean square of the unexplained residuals, m, beyond which the logs are not of two feet of one walk.
const APART: f64 = 0.35;
/// The root mean square distance, m, beyond which the logs are not of two sensors on one foot.
const APART_ON_ONE_FOOT: f64 = 0.15;

/// How well the path of the other sensor fits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BothFeet {
    /// The number of times both were at one place.
    pub meetings: usize,
    /// The root mean square distance between them there, beyond an offset that is constant along the way, m.
    pub distance_m: f64,
    /// The remaining standard deviation of the heading's rate, rad/s.
    pub rate_sigma: f64,
    /// The remaining standard deviation of each stride's own error, for each axis, m.
    pub stride_sigma: f64,
}

impl Walk {
    /// Corrects the path by that of the other foot, on the same clock: where one foot passes the other, both are at
    /// nearly the same place. Two sensors on one foot are at one place where they stand. Heading rate, scale and errors
    /// of strides are the most likely ones for both paths, given their size for either
    /// ([`PathUncertainty`](kestirim_pedestrian::PathUncertainty)), by least squares over the whole walk; the frame of
    /// the other path need not be known. Heights and the lengths of strides remain unchanged.
    ///
    /// Standard deviations are those that remain if the rates of both are independent, and the stride errors of two
    /// feet. Scales are not assumed to be independent: the tracker makes the same errors for both feet.
    ///
    /// The idea is that of Skog, Nilsson, Zachariah and Händel (Fusing the information from two navigation systems using an upper
    /// bound on their maximum spatial separation, IPIN 2012); the bound here is a standard deviation, and at each meeting.
    ///
    /// # Errors
    /// A sentence if both are seldom at one place, if the paths do not fit, if they are the same or were joined before,
    /// or if another source, a magnetometer, has corrected the heading of only one: the walk then remains unchanged.
    pub fn join_other_foot(&mut self, other: &Self) -> Result<BothFeet, String> {
        let refused = |why: &str| Err(format!("the other foot is not used: {why}"));
        if self.track == other.track {
            return refused("its log is that of this one");
        }
        if self.both_feet.is_some() || other.both_feet.is_some() {
            return refused("both were joined before");
        }
        // Half of one path's drift would be put into the other.
        if self.heading_rate.is_some() != other.heading_rate.is_some() {
            return refused("a magnetometer has corrected the heading of one alone");
        }
        let problem = Problem::of(self, other);
        let count = problem.meetings.len();
        if count < FEWEST {
            return refused(&format!(
                "{count} times one foot passes the other, or both stand at once; {FEWEST} are needed"
            ));
        }
        let Some(solved) = problem.solve() else { return refused("no solution is found") };
        let (apart, most) = if problem.is_of_one_foot() {
            (problem.distance(&solved.guess), APART_ON_ONE_FOOT)
        } else {
            (problem.left_over(&solved.guess), APART)
        };
        if apart > most {
            return refused(&format!(
                "where both should be at one place they are {apart:.2} m apart; are both logs of this walk, and on one clock?"
            ));
        }
        Ok(self.corrected_by(&problem, &solved))
    }

    fn corrected_by(&mut self, problem: &Problem, solved: &Solved) -> BothFeet {
        let errors = PathErrors::of(self);
        let [rate, scale] = [0, 1].map(|of| solved.guess.unknowns[OWN + of]);
        self.turn_back(rate);
        self.shorten(scale);
        let course = problem.corrections(&solved.guess);
        let half = |time_us: u64| {
            let [x, y, _] = position_at(&course, time_us).unwrap_or_default();
            [0.5 * x, 0.5 * y, 0.0]
        };
        self.displace(&self.strides.iter().map(|it| half(it.time_us)).collect::<Vec<_>>());
        let left = |i: usize, j: usize| solved.solution.parameter_covariance[(OWN + i, OWN + j)];
        let variances = Matrix2::new(left(0, 0), left(0, 1), left(1, 0), errors.scale.powi(2));
        let walked = problem.own.path.walked(rate, scale);
        let own = errors.stride.powi(2);
        let is_of_one_foot = problem.is_of_one_foot();
        let (mut seen, mut stepped) = (0.0, 0.0);
        let is_unseen = self.strides.iter().any(Stride::is_unseen);
        for (index, (stride, (_, slope))) in self.strides.iter_mut().zip(walked).enumerate() {
            let of_both = slope * variances * slope.transpose();
            if !is_of_one_foot && problem.is_seen(stride.time_us) {
                seen += 1.0;
            }
            // Half of the difference between both paths' stride errors is removed, as accurately as it is known; their
            // sum is unknown.
            let known = problem.correction_variance(&solved.solution, stride.time_us);
            let unseen = (index + 1) as f64 - seen;
            stepped = own * (unseen + 0.5 * seen) + 0.25 * known.min(2.0 * own * seen);
            let of_axis = |axis: usize| (of_both[(axis, axis)] + stepped).sqrt();
            // A lost heading is not a constant rate, so these errors do not describe it.
            let [x, y] =
                if is_unseen { [0, 1].map(|k| stride.sigma_m[k]) } else { [0, 1].map(of_axis) };
            stride.sigma_m = [x, y, stride.sigma_m[2]];
        }
        let feet = BothFeet {
            meetings: problem.meetings.len(),
            distance_m: problem.distance(&solved.guess),
            rate_sigma: left(0, 0).max(0.0).sqrt(),
            stride_sigma: (stepped / self.strides.len().max(1) as f64).sqrt(),
        };
        self.both_feet = Some(feet);
        feet
    }
}
