//! Motion of a robot on wheels.

use super::state::{BIAS, COSINE, COUNT, DRIFT, GAIN, SINE, X, Y};
use kestirim_kalman::{Gaussian, Process};
use kestirim_scalar::{Components, Scalar};

/// A step as counted by the wheels.
///
/// Physics: the wheels count a way δ = (cos φ, sin φ) d in a frame of their own, with the turns φ so far and the
/// length d of the step. In the room it is K δ, K = \[c, −s; s, c\], which rotates by the heading at which the count
/// began, and stretches by the wheels' scale. With c and s as states this is **linear**: neither the heading nor the
/// sign of the wheels' count need be known at the start. The turns are φ̇ = g ω + w, and errors of g and w rotate (c,
/// s).
///
/// Source: the linear form of relative orientation and scale is that of visual-inertial initialisation (Martinelli
/// 2014); for wheel odometry, Siegwart, Nourbakhsh and Scaramuzza 2011, 5.2.4.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drive<T> {
    /// Duration of the step, s.
    pub(crate) interval: T,
    /// The way in the frame of the count, m.
    pub(crate) way: [T; 2],
    /// The measured turn, rad.
    pub(crate) turn: T,
    /// Variance that the step adds to each coordinate, m².
    pub(crate) position_noise: T,
    /// Variance that the step adds to c and s.
    pub(crate) heading_noise: T,
}

impl<T: Scalar> Drive<T> {
    /// Random walks of the drift, (rad in 100 s)²/s, and of the common bias, m²/s.
    const DRIFT_DENSITY: f64 = 1e-4;
    const BIAS_DENSITY: f64 = 1e-5;
}

impl<T: Scalar> Process<T, COUNT> for Drive<T> {
    #[inline]
    fn advance(&self, estimate: &mut Gaussian<T, COUNT>) {
        let ([ahead, left], mean) = (self.way, estimate.mean.as_array_mut());
        let (cosine, sine) = (mean[COSINE], mean[SINE]);
        mean[X] += ahead * cosine - left * sine;
        mean[Y] += ahead * sine + left * cosine;
        let covariance = &mut estimate.covariance;
        covariance.shear::<X, COSINE>(ahead);
        covariance.shear::<X, SINE>(-left);
        covariance.shear::<Y, SINE>(ahead);
        covariance.shear::<Y, COSINE>(left);
        let drift = self.interval * T::from_f64(0.01);
        covariance.shear::<COSINE, DRIFT>(-sine * drift);
        covariance.shear::<SINE, DRIFT>(cosine * drift);
        if self.turn != T::ZERO {
            covariance.shear::<COSINE, GAIN>(-sine * self.turn);
            covariance.shear::<SINE, GAIN>(cosine * self.turn);
        }
        covariance.add_variance::<X>(self.position_noise);
        covariance.add_variance::<Y>(self.position_noise);
        covariance.add_variance::<COSINE>(self.heading_noise);
        covariance.add_variance::<SINE>(self.heading_noise);
        covariance.add_variance::<DRIFT>(self.interval * T::from_f64(Self::DRIFT_DENSITY));
        covariance.add_variance::<BIAS>(self.interval * T::from_f64(Self::BIAS_DENSITY));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_kalman::Covariance;
    use nalgebra::{SMatrix, SVector};

    #[test]
    fn a_step_is_the_linear_process_of_its_physics() {
        let drive = Drive {
            interval: 0.4,
            way: [0.6, -0.2],
            turn: 0.3,
            position_noise: 0.02,
            heading_noise: 0.003,
        };
        // A covariance in which all states are correlated.
        let root = SMatrix::<f64, COUNT, COUNT>::from_fn(|i, j| {
            0.1 * ((3 * i + 5 * j) % 7) as f64 + f64::from(u8::from(i == j))
        });
        let before = root * root.transpose();
        let mean = SVector::from([1.0, 2.0, 0.8, -0.5, 0.3, 1.1, 0.2, 0.1]);
        let mut estimate = Gaussian::new(mean, Covariance::from_lower_triangle(&before));
        estimate.advance(&drive).expect("a step");

        // K δ with K = [c, −s; s, c]; the turns' drift (rad in 100 s) and gain turn (c, s).
        let mut f = SMatrix::<f64, COUNT, COUNT>::identity();
        let [ahead, left] = drive.way;
        (f[(X, COSINE)], f[(X, SINE)], f[(Y, COSINE)], f[(Y, SINE)]) = (ahead, -left, left, ahead);
        let moved = f * mean;
        let mut turned = SMatrix::<f64, COUNT, COUNT>::identity();
        for (state, by) in [(DRIFT, 0.01 * drive.interval), (GAIN, drive.turn)] {
            (turned[(COSINE, state)], turned[(SINE, state)]) =
                (-mean[SINE] * by, mean[COSINE] * by);
        }
        let f = turned * f;
        let mut after = f * before * f.transpose();
        // The drift's random walk is a hundredth of a radian in 100 s per √s, the bias's a centimetre in ten seconds.
        for (state, variance) in
            [(X, 0.02), (Y, 0.02), (COSINE, 0.003), (SINE, 0.003), (DRIFT, 0.4e-4), (BIAS, 0.4e-5)]
        {
            after[(state, state)] += variance;
        }
        assert!((estimate.mean - moved).amax() < 1e-12, "{} {moved}", estimate.mean);
        let difference = estimate.covariance.to_matrix() - after;
        assert!(difference.amax() < 1e-9, "{difference}");
    }
}
