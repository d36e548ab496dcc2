//! Measurement models, one per file: physics, source, Jacobian, and the gate that a measurement must pass.
//!
//! Each is an [`Observation`](kestirim_kalman::Observation) of the tracker's states: D coordinates (m), D velocities
//! (m/s), optionally a common bias (m).

mod proportional_range;
mod range;
mod speed;
mod standstill;

pub(crate) use proportional_range::ProportionalRange;
pub(crate) use range::Range;
pub(crate) use speed::Speed;
pub(crate) use standstill::Standstill;

/// NIS of a velocity measurement above which it is rejected: 3 σ.
const CONTRADICTION: f64 = 9.0;

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_kalman::{Covariance, Error, Gaussian, Observation};
    use nalgebra::{SVector, vector};

    /// Checks that the row of an observation is the derivative of its expected value, the negative of that of the
    /// innovation.
    fn has_the_slope_of_its_row<const N: usize>(
        observation: &impl Observation<f64, N>,
        mean: SVector<f64, N>,
    ) {
        const STEP: f64 = 1e-6;
        let innovation = |mean| observation.linearise(&mean).expect("it has a slope").0;
        let (_, row) = observation.linearise(&mean).expect("it has a slope");
        let mut slope = SVector::<f64, N>::zeros();
        for &(index, value) in row.as_ref() {
            slope[index] += value;
        }
        for index in 0..N {
            let step = SVector::from_fn(|other, _| if other == index { STEP } else { 0.0 });
            let found = (innovation(mean - step) - innovation(mean + step)) / (2.0 * STEP);
            assert!((found - slope[index]).abs() < 1e-6, "{index}: {found}, {slope}");
        }
    }

    fn innovation<const N: usize>(
        observation: &impl Observation<f64, N>,
        mean: SVector<f64, N>,
    ) -> f64 {
        observation.linearise(&mean).expect("an innovation").0
    }

    #[test]
    fn a_range_is_a_distance_and_a_bias_that_grows_with_it() {
        let anchor = vector![1.0, 2.0, 3.0];
        // 2 m, 3 m and 6 m along the axes: 7 m.
        let range = |observes_bias| Range::<f64, 2> {
            measured: 9.0,
            anchor: &anchor,
            height: 9.0,
            observes_bias,
            bias_shape: [0.25, 0.125],
        };
        let unbiased = vector![3.0, 5.0, 0.3, -0.4, 0.0];
        has_the_slope_of_its_row(&range(true), unbiased);
        has_the_slope_of_its_row(&range(true), unbiased.fixed_rows::<4>(0).into_owned());
        assert!((innovation(&range(true), unbiased) - 2.0).abs() < 1e-12);
        let biased = vector![3.0, 5.0, 0.3, -0.4, 0.8];
        assert!((innovation(&range(true), biased) - (2.0 - 0.8 * 1.125)).abs() < 1e-12);
        // With too few anchors, the known bias is subtracted, but not updated.
        assert_eq!(innovation(&range(false), biased), innovation(&range(true), biased));
        let (of_all, of_few) = (range(true).linearise(&biased), range(false).linearise(&biased));
        let (of_all, of_few) = (of_all.expect("a row").1, of_few.expect("a row").1);
        assert_eq!(of_few.as_ref()[..2], of_all.as_ref()[..2]);
        assert_eq!(of_few.as_ref()[2..], [(4, 0.0)]);
    }

    #[test]
    fn a_range_in_space_has_three_directions() {
        let anchor = vector![1.0, 2.0, 3.0];
        let range = Range::<f64, 3> {
            measured: 9.0,
            anchor: &anchor,
            height: 0.0,
            observes_bias: true,
            bias_shape: [1.0, 0.0],
        };
        has_the_slope_of_its_row(&range, vector![3.0, 5.0, 9.0, 0.0, 0.0, 0.0, 0.0]);
        has_the_slope_of_its_row(&range, vector![3.0, 5.0, 9.0, 0.0, 0.0, 0.0]);
        assert_eq!(innovation(&range, vector![3.0, 5.0, 9.0, 0.0, 0.0, 0.0, 0.5]), 1.5);
    }

    #[test]
    fn a_range_on_wheels_is_long_by_a_bias_and_in_proportion() {
        let anchor = vector![1.0, 2.0, 3.0];
        let range = ProportionalRange { measured: 9.0, anchor: &anchor, height: 9.0 };
        let mean = vector![3.0, 5.0, 0.8, -0.6, 0.1, 1.0, 0.4, 0.5];
        has_the_slope_of_its_row(&range, mean);
        // 7 m, plus 7 times half a metre in ten, and 0.4 m.
        assert!((innovation(&range, mean) - (9.0 - 7.0 - 0.35 - 0.4)).abs() < 1e-12);
    }

    #[test]
    fn wheels_measure_the_size_of_a_velocity_that_has_a_direction() {
        let speed = |measured| Speed::<f64, 2> { measured };
        let moving = vector![0.0, 0.0, 0.3, -0.4];
        for measured in [0.7, -0.7, 0.0, 0.999] {
            has_the_slope_of_its_row(&speed(measured), moving);
            let innovation = innovation(&speed(measured), moving);
            assert!(
                (innovation - (measured.abs() - 0.5)).abs() < 1e-12,
                "{measured}: {innovation}"
            );
        }
        let refused =
            |measured, mean| speed(measured).linearise(&mean).err() == Some(Error::NotLinearisable);
        assert!(!refused(1.0, moving) && refused(1.001, moving), "more than twice the speed");
        assert!(refused(0.0, vector![9.0, 9.0, 0.02, 0.0]), "hardly any velocity");
        has_the_slope_of_its_row(&speed(0.0), vector![9.0, 9.0, 0.021, 0.0]);
    }

    /// A velocity of this magnitude with this standard deviation.
    fn moving(speed: f64, sigma: f64) -> Gaussian<f64, 4> {
        let (position, velocity) = (1.0, sigma * sigma);
        let variances = [position, position, velocity, velocity];
        Gaussian::new(vector![1.0, 2.0, speed, 0.0], Covariance::from_variances(&variances))
    }

    #[test]
    fn a_speed_within_three_deviations_is_taken_in() {
        // 0.1 m/s for the wheels and as much for the estimate: three standard deviations are 0.424 m/s.
        for (measured, taken) in [(1.42, true), (1.43, false), (0.58, true), (0.57, false)] {
            let mut estimate = moving(1.0, 0.1);
            Speed::<f64, 2> { measured }.correct(&mut estimate).expect("a speed");
            let half_way = if taken { f64::midpoint(1.0, measured) } else { 1.0 };
            assert!((estimate.mean[2] - half_way).abs() < 1e-9, "{measured}: {}", estimate.mean);
        }
        let mut estimate = moving(0.0, 0.1);
        Speed::<f64, 2> { measured: 0.1 }.correct(&mut estimate).expect("nothing to take in");
        assert_eq!(estimate, moving(0.0, 0.1), "without a direction");
    }

    #[test]
    fn a_standstill_is_a_velocity_of_zero_in_every_direction() {
        let mut estimate = moving(0.03, 0.5);
        estimate.mean[3] = -0.02;
        Standstill::correct::<f64, 2, 4>(&mut estimate).expect("a standstill");
        assert!(estimate.mean.rows(2, 2).amax() < 1e-4, "{}", estimate.mean);
        for sigma in estimate.covariance.variances().rows(2, 2).map(f64::sqrt).iter() {
            assert!((sigma - 0.015).abs() < 1e-4, "{sigma}");
        }
        assert_eq!(estimate.mean.rows(0, 2), vector![1.0, 2.0]);
        let (mean, variances) = (vector![9.0, 9.0, 9.0, 1.0, 1.0, 1.0, 9.0], [1.0; 7]);
        let mut space = Gaussian::new(mean, Covariance::from_variances(&variances));
        Standstill::correct::<f64, 3, 7>(&mut space).expect("a standstill");
        let moved = space.mean - vector![9.0, 9.0, 9.0, 0.0, 0.0, 0.0, 9.0];
        assert!(moved.amax() < 1e-3, "{moved}");
    }

    #[test]
    fn a_standstill_agrees_with_velocities_within_three_deviations() {
        // 0.02 m/s for the estimate and 0.015 m/s for the standstill: three standard deviations are 0.075 m/s.
        for (speed, agrees) in [(0.0749, true), (0.0751, false), (-0.0749, true), (-0.0751, false)]
        {
            let estimate = moving(speed, 0.02);
            assert_eq!(Standstill::agrees::<f64, 2, 4>(&estimate), agrees, "{speed}");
            let mut other = moving(0.0, 0.02);
            other.mean[3] = speed;
            assert_eq!(Standstill::agrees::<f64, 2, 4>(&other), agrees, "{speed}");
        }
    }
}
