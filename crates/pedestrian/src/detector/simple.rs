use super::window::SlidingMean;
use super::{Motion, StanceDetector, Verdict};
use kestirim_scalar::{Components, Scalar};

/// The detector of the paper (AHRS and ZUPT on a Razor IMU, eq. 2): stance where the magnitude of a single sample is within a
/// threshold of 1 g.
///
/// As published, and here, it triggers many times inside every swing, where |f| passes through 1 g, and loses most of
/// the path. It is offered for comparison.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Magnitude<T> {
    threshold_g: T,
}

impl<T: Scalar> Magnitude<T> {
    /// The paper's threshold, in g.
    pub const THRESHOLD_G: f64 = 0.1;

    /// Creates a detector of stance where ||f| − 1 g| < `threshold_g`, in g.
    pub fn new(threshold_g: T) -> Self {
        Self { threshold_g }
    }
}

impl<T: Scalar> StanceDetector<T> for Magnitude<T> {
    #[inline]
    fn update(&mut self, motion: &Motion<T>) -> Verdict<T> {
        let [x, y, z] = *motion.force_g.as_array();
        let deviation = x.hypot(y).hypot(z) - T::ONE;
        Verdict { stance: deviation.abs() < self.threshold_g, statistic: T::ZERO }
    }
}

/// A detector of stance where the variance of |f| over 100 ms is below a threshold (acceleration moving variance).
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: Copy + serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct MovingVariance<T> {
    window: SlidingMean<T, 2>,
    threshold_g2: T,
}

impl<T: Scalar> MovingVariance<T> {
    /// The default threshold, in g².
    pub const THRESHOLD_G2: f64 = 0.0015;
    /// The length of the window (µs).
    const WINDOW_US: u32 = 97_500;
    /// The upper limit on a magnitude (g), so that squares fit in fixed point.
    const CEILING: f64 = 7.0;

    /// Creates a detector of stance below `threshold_g2`, in g².
    pub fn new(threshold_g2: T) -> Self {
        Self { window: SlidingMean::new(Self::WINDOW_US), threshold_g2 }
    }
}

impl<T: Scalar> StanceDetector<T> for MovingVariance<T> {
    #[inline]
    fn update(&mut self, motion: &Motion<T>) -> Verdict<T> {
        let [x, y, z] = *motion.force_g.as_array();
        // The square of the deviation from 1 g loses fewer digits than that of the magnitude.
        let deviation = (x.hypot(y).hypot(z) - T::ONE).min(T::from_f64(Self::CEILING));
        let [mean, square] = self.window.push(motion.time_us, [deviation, deviation * deviation]);
        Verdict { stance: square - mean * mean < self.threshold_g2, statistic: T::ZERO }
    }
}

/// A detector of stance where the mean of |ω|² over 50 ms is below a threshold (angular rate energy).
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: Copy + serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct AngularRateEnergy<T> {
    window: SlidingMean<T, 1>,
    threshold: T,
}

impl<T: Scalar> AngularRateEnergy<T> {
    /// The default threshold, in (rad/s)².
    pub const THRESHOLD: f64 = 0.4;
    /// The length of the window (µs).
    const WINDOW_US: u32 = 47_500;
    /// The largest contribution of one sample, (rad/s)².
    const CEILING: f64 = 60.0;

    /// Creates a detector of stance below `threshold`, in (rad/s)².
    pub fn new(threshold: T) -> Self {
        Self { window: SlidingMean::new(Self::WINDOW_US), threshold }
    }
}

impl<T: Scalar> StanceDetector<T> for AngularRateEnergy<T> {
    #[inline]
    fn update(&mut self, motion: &Motion<T>) -> Verdict<T> {
        let rate = motion.angular_rate.as_array();
        let square = T::dot(rate, rate).min(T::from_f64(Self::CEILING));
        let [energy] = self.window.push(motion.time_us, [square]);
        Verdict { stance: energy < self.threshold, statistic: T::ZERO }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SVector;

    /// Whether a foot stands after a second of a force along an axis (g) and a rate (rad/s) per sample.
    fn stands(mut detector: impl StanceDetector<f64>, motion: impl Fn(u32) -> (f64, f64)) -> bool {
        let mut stance = false;
        for k in 0..100 {
            let (force, rate) = motion(k);
            let force_g = SVector::from([0.0, 0.6 * force, 0.8 * force]);
            let angular_rate = SVector::from([0.0, rate * 0.6, rate * 0.8]);
            stance = detector.update(&Motion { time_us: k * 10_000, force_g, angular_rate }).stance;
        }
        stance
    }

    #[test]
    fn a_magnitude_is_within_a_tenth_of_gravity() {
        for (force, stance) in
            [(1.0, true), (1.09, true), (0.91, true), (1.11, false), (0.89, false)]
        {
            let detector = Magnitude::new(Magnitude::<f64>::THRESHOLD_G);
            assert_eq!(stands(detector, |_| (force, 9.0)), stance, "{force} g");
        }
    }

    #[test]
    fn a_variance_does_not_see_what_is_constant() {
        let detector = || MovingVariance::new(0.01);
        assert!(stands(detector(), |_| (3.0, 9.0)));
        // Shaking by a tenth of gravity has a variance of a hundredth.
        let shaken =
            |by: f64| stands(detector(), |k| (if k % 2 == 0 { 1.0 + by } else { 1.0 - by }, 0.0));
        assert!(shaken(0.098) && !shaken(0.102));
        // However hard the blow, it counts as 7 g: over ten samples 0.7² is subtracted from a tenth of its square.
        let hit = |threshold| {
            stands(MovingVariance::new(threshold), |k| (if k == 95 { 1e9 } else { 1.0 }, 0.0))
        };
        assert!(hit(4.42) && !hit(4.40));
    }

    #[test]
    fn an_energy_is_the_mean_square_of_the_rate() {
        let detector = || AngularRateEnergy::new(0.25);
        assert!(stands(detector(), |_| (5.0, 0.49)) && !stands(detector(), |_| (1.0, 0.51)));
        let hit = |threshold| {
            stands(AngularRateEnergy::new(threshold), |k| (1.0, if k == 98 { 1e9 } else { 0.0 }))
        };
        // Five samples, one of which counts as 60.
        assert!(hit(12.1) && !hit(11.9));
    }
}
