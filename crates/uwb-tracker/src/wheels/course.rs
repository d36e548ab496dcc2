//! One hypothesis of the position and heading of a robot on wheels.

use super::drive::Drive;
use super::state::{BIAS, COSINE, COUNT, DRIFT, EXCESS, GAIN, SINE, X, Y};
use crate::mirror::ROOM_MARGIN;
use crate::wheel_noise::{
    DRIFT_SIGMA, GAIN_SIGMA, SLIP, TURN_TO_HEADING, UNKNOWN_SPEED, UNKNOWN_TIME, UNKNOWN_TURN,
    WAY_TO_HEADING,
};
use crate::{Error, OdometrySample};
use kestirim_kalman::{Covariance, Gaussian, Innovation};
use kestirim_scalar::{Columns, Components, Scalar};
use kestirim_uwb_ranging::Room;
use nalgebra::{SMatrix, SVector};

/// An estimate, the turns that the wheels have counted, and its likelihood from the ranges.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Course<T: Scalar> {
    pub(super) estimate: Gaussian<T, COUNT>,
    /// Counted turn φ, rad, within ±π.
    turned: T,
    /// Sum of NIS + ln S of the ranges: −2 times their log-likelihood, up to a constant.
    pub(super) cost: T,
}

/// Initial variance of c and s with an unknown heading, for a scale of about 1.
const HEADING_VARIANCE: f64 = 0.5;
/// Difference of costs (−2 times the log-likelihood) beyond which the worse course is given up: a probability of one
/// in 20,000.
const DECIDED: f64 = 20.0;

impl<T: Scalar> Course<T> {
    /// A course that starts at a position (of an estimate in the plane: x, y, and states that are ignored here), with
    /// these standard deviations (m) of the common bias and of the excess in 10 m, and turns of this sign.
    pub(super) fn begun<const N: usize>(
        start: &Gaussian<T, N>,
        [bias, excess]: [T; 2],
        gain: T,
    ) -> Self {
        let number = T::from_f64;
        let mut mean = SVector::<T, COUNT>::zeros();
        let [x, y] = [0, 1].map(|axis| start.mean.get(axis).copied().unwrap_or(T::ZERO));
        let known = mean.as_array_mut();
        (known[X], known[Y], known[GAIN]) = (x, y, gain);
        let known = |i, j| start.covariance.get(i, j).unwrap_or(T::ZERO);
        let mut matrix = SMatrix::<T, COUNT, COUNT>::zeros();
        let lower = matrix.as_columns_mut();
        (lower[X][X], lower[X][Y], lower[Y][Y]) = (known(0, 0), known(0, 1), known(1, 1));
        lower[COSINE][COSINE] = number(HEADING_VARIANCE);
        lower[SINE][SINE] = number(HEADING_VARIANCE);
        lower[DRIFT][DRIFT] = number(DRIFT_SIGMA * DRIFT_SIGMA);
        lower[GAIN][GAIN] = number(GAIN_SIGMA * GAIN_SIGMA);
        lower[BIAS][BIAS] = bias * bias;
        lower[EXCESS][EXCESS] = excess * excess;
        let covariance = Covariance::from_lower_triangle(&matrix);
        Self { estimate: Gaussian::new(mean, covariance), turned: T::ZERO, cost: T::ZERO }
    }

    /// Predicts over `interval` (s) without odometry: the motion is unknown, at up to the last `speed` (m/s) of the
    /// wheels.
    ///
    /// # Errors
    /// [`Error::Estimate`].
    #[inline(never)] // Rare.
    pub(super) fn drift(&mut self, interval: T, speed: T) -> Result<(), Error> {
        let number = T::from_f64;
        let square = (speed * speed).max(number(UNKNOWN_SPEED * UNKNOWN_SPEED));
        let position_noise = interval * square * number(UNKNOWN_TIME);
        let heading_noise = interval * number(UNKNOWN_TURN);
        let (way, turn) = ([T::ZERO; 2], T::ZERO);
        Ok(self.estimate.advance(&Drive { interval, way, turn, position_noise, heading_noise })?)
    }

    /// Predicts over `interval` (s) according to the wheels. The noise is multiplied by `doubt`.
    ///
    /// # Errors
    /// [`Error::Estimate`].
    #[inline]
    pub(super) fn drive(
        &mut self,
        interval: T,
        wheels: &OdometrySample<T>,
        doubt: T,
    ) -> Result<(), Error> {
        let number = T::from_f64;
        let mean = self.estimate.mean.as_array();
        let (way, turn) = (wheels.speed * interval, wheels.turn_rate * interval);
        let turns = mean[GAIN] * turn + mean[DRIFT] * interval * number(0.01);
        let (sine, cosine) = (self.turned + turns * T::HALF).sin_cos();
        let (length, angle) = (way.abs() * doubt, turn.abs() * doubt);
        self.estimate.advance(&Drive {
            interval,
            way: [way * cosine, way * sine],
            turn,
            position_noise: length * number(SLIP),
            heading_noise: length * number(WAY_TO_HEADING) + angle * number(TURN_TO_HEADING),
        })?;
        self.turned = wrapped(self.turned + turns);
        Ok(())
    }

    /// Adds the cost of a range.
    #[inline]
    pub(super) fn charge(&mut self, seen: &Innovation<T>, most: T) {
        self.cost += seen.nis.min(most) + seen.variance.ln();
    }
}

/// The angle reduced to ±π.
#[inline]
fn wrapped<T: Scalar>(angle: T) -> T {
    let turn = T::TWO * T::PI;
    if angle.abs() <= T::PI {
        angle
    } else if angle.abs() < turn {
        if angle > T::ZERO { angle - turn } else { angle + turn }
    } else {
        let (sine, cosine) = angle.sin_cos();
        sine.atan2(cosine)
    }
}

/// Both courses, until one is much more likely than the other.
pub(super) fn decided<T: Scalar>(courses: [Option<Course<T>>; 2]) -> [Option<Course<T>>; 2] {
    let [Some(mut first), Some(mut second)] = courses else { return courses };
    let most = T::from_f64(DECIDED);
    if first.cost > second.cost + most {
        return [None, Some(second)];
    }
    if second.cost > first.cost + most {
        return [Some(first), None];
    }
    // Only their difference matters.
    let least = first.cost.min(second.cost);
    first.cost -= least;
    second.cost -= least;
    [Some(first), Some(second)]
}

/// The courses that have not left the room, with a margin of half a metre and three standard deviations.
#[inline(never)] // Only called if a room is known.
pub(super) fn within<T: Scalar>(
    courses: [Option<Course<T>>; 2],
    room: &Room<T>,
) -> [Option<Course<T>>; 2] {
    let is_within = |course: &Course<T>| {
        let (mean, variances) = (&course.estimate.mean, course.estimate.covariance.variances());
        let (mean, variances) = (mean.as_array(), variances.as_array());
        let sigma = (variances[X] + variances[Y]).sqrt();
        let margin = T::from_f64(ROOM_MARGIN) + T::from_f64(3.0) * sigma;
        room.contains(&SVector::<T, 2>::from([mean[X], mean[Y]]), margin)
    };
    courses.map(|course| course.filter(is_within))
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;

    /// Wheels that report half of the way, turned by 0.7 rad, with a gain and a drift of their turns.
    fn course() -> Course<f64> {
        let mut mean = SVector::zeros();
        (mean[X], mean[Y]) = (3.0, -4.0);
        (mean[COSINE], mean[SINE]) = (2.0 * 0.7_f64.cos(), 2.0 * 0.7_f64.sin());
        (mean[GAIN], mean[DRIFT]) = (1.5, 1.0);
        Course { estimate: Gaussian::new(mean, Covariance::zero()), turned: 0.0, cost: 0.0 }
    }

    fn wheels(speed: f64, turn_rate: f64) -> OdometrySample<f64> {
        OdometrySample { time_us: 0, speed, turn_rate }
    }

    #[test]
    fn a_constant_turn_is_an_arc() {
        for way in [0.5, -0.5] {
            let mut course = course();
            for _ in 0..600 {
                course.drive(0.05, &wheels(way, 0.2), 1.0).expect("a step");
            }
            // 1 m/s, and 1.5 times the turn rate plus 0.01 rad/s, for half a minute: one and a half turns.
            let (speed, rate, time) = (2.0 * way, 0.31, 30.0);
            let (begin, end) = (0.7, 0.7 + rate * time);
            let x = 3.0 + speed / rate * (f64::sin(end) - f64::sin(begin));
            let y = -4.0 - speed / rate * (f64::cos(end) - f64::cos(begin));
            let mean = &course.estimate.mean;
            assert!((mean[X] - x).hypot(mean[Y] - y) < 1e-3, "{mean} {x} {y}");
            assert!(course.turned.abs() <= PI, "{}", course.turned);
            assert!((course.turned - (rate * time - 2.0 * PI)).abs() < 1e-9, "{}", course.turned);
        }
    }

    #[test]
    fn wheels_slip_by_way_and_turn_and_doubt() {
        for (speed, turn_rate, doubt) in
            [(1.0, 0.0, 1.0), (-1.0, 0.0, 1.0), (1.0, 0.0, 3.0), (0.0, 0.5, 2.0), (0.0, -0.5, 2.0)]
        {
            let mut course = course();
            course.drive(0.1, &wheels(speed, turn_rate), doubt).expect("a step");
            let variances = course.estimate.covariance.variances();
            let (way, turn) = (0.1 * speed.abs() * doubt, 0.1 * f64::abs(turn_rate) * doubt);
            for (index, variance) in [(X, way * SLIP), (Y, way * SLIP)]
                .into_iter()
                .chain([COSINE, SINE].map(|it| (it, way * WAY_TO_HEADING + turn * TURN_TO_HEADING)))
            {
                assert!((variances[index] - variance).abs() < 1e-12, "{index}: {variances}");
            }
        }
    }

    #[test]
    fn without_wheels_it_drives_on_somehow() {
        // It keeps a direction for two seconds, and is random beyond; at half a metre per second at least.
        for (last, speed) in [(0.0, 0.5), (0.3, 0.5), (2.0, 2.0), (-2.0, 2.0)] {
            let mut course = course();
            course.drift(4.0, last).expect("a step");
            assert_eq!(course.estimate.mean, self::course().estimate.mean);
            let variances = course.estimate.covariance.variances();
            for index in [X, Y] {
                assert!((variances[index] - 4.0 * 2.0 * speed * speed).abs() < 1e-9, "{variances}");
            }
            for index in [COSINE, SINE] {
                assert!((variances[index] - 0.4).abs() < 1e-9, "{variances}");
            }
        }
    }

    #[test]
    fn a_course_begins_at_the_start_and_knows_no_heading() {
        let matrix = SMatrix::<f64, 5, 5>::from_diagonal_element(9.0);
        let mut matrix = matrix;
        (matrix[(0, 0)], matrix[(1, 0)], matrix[(1, 1)]) = (2.0, 0.5, 1.0);
        let mean = SVector::from([3.0, -4.0, 1.0, 1.0, 1.0]);
        let start = Gaussian::new(mean, Covariance::from_lower_triangle(&matrix));
        let course = Course::begun(&start, [0.3, 0.2], -1.0);
        let expected = SVector::from([3.0, -4.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0]);
        assert_eq!(course.estimate.mean, expected);
        let p = &course.estimate.covariance;
        assert_eq!([(0, 0), (0, 1), (1, 1)].map(|(i, j)| p.get(i, j)), [2.0, 0.5, 1.0].map(Some));
        let sigmas = p.variances().map(f64::sqrt);
        for (index, sigma) in [(DRIFT, 1.0), (GAIN, 0.5), (BIAS, 0.3), (EXCESS, 0.2)] {
            assert!((sigmas[index] - sigma).abs() < 1e-9, "{index}: {sigmas}");
        }
        // With a scale of 1 in any direction each coordinate has a variance of a half.
        assert_eq!([COSINE, SINE].map(|index| p.get(index, index)), [Some(0.5); 2]);
        assert_eq!((course.turned, course.cost), (0.0, 0.0));
    }

    #[test]
    fn an_angle_is_the_same_within_half_a_turn() {
        for step in -400..=400 {
            let angle = 0.05 * f64::from(step);
            let wrapped = wrapped(angle);
            assert!(wrapped.abs() <= PI + 1e-9, "{angle}: {wrapped}");
            let (sine, cosine) = wrapped.sin_cos();
            assert!((sine - angle.sin()).hypot(cosine - angle.cos()) < 1e-9, "{angle}: {wrapped}");
        }
    }

    #[test]
    fn a_range_costs_what_its_probability_tells() {
        let mut course = course();
        let seen = |nis| Innovation { innovation: 1.0, variance: 0.5, nis };
        course.charge(&seen(3.0), 25.0);
        course.charge(&seen(1000.0), 25.0);
        assert!((course.cost - (28.0 + 2.0 * 0.5_f64.ln())).abs() < 1e-12, "{}", course.cost);
    }

    #[test]
    fn a_course_is_given_up_that_is_much_less_probable() {
        let costs = |first, second| {
            let course = |cost| Some(Course { cost, ..course() });
            decided([course(first), course(second)]).map(|course| course.map(|course| course.cost))
        };
        assert_eq!(costs(7.0, 27.0), [Some(0.0), Some(20.0)]);
        assert_eq!(costs(27.0, 7.0), [Some(20.0), Some(0.0)]);
        assert_eq!(costs(7.0, 27.1), [Some(7.0), None]);
        assert_eq!(costs(27.1, 7.0), [None, Some(7.0)]);
        assert!(decided::<f64>([None, None]).iter().all(Option::is_none));
        let alone = decided([None, Some(Course { cost: 50.0, ..course() })]);
        assert!(alone[0].is_none() && alone[1].is_some_and(|course| course.cost == 50.0));
    }
}
