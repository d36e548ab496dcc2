use super::window::SlidingMean;
use super::{Motion, StanceDetector, Verdict};
use kestirim_scalar::{Components, Scalar};

/// The detector of the paper (AHRS and ZUPT on a Razor IMU, eq. 2): stance where the magnitude of a single sample is within a
/// threshold of 1 g.
///
/// As published, and here, it fires many times inside every swing, where |f| passes through 1 g, and
/// loses most of the path. It is offered for comparison.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Magnitude<T> {
    threshold_g: T,
}

impl<T: Scalar> Magnitude<T> {
    /// The paper's threshold, in g.
    pub const THRESHOLD_G: f64 = 0.1;

    /// Stance where ||f| − 1 g| < `threshold_g`, in g.
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

/// Stance where the variance of |f| over 100 ms is below a threshold (acceleration moving variance).
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
    /// The window (µs).
    const WINDOW_US: u32 = 97_500;
    /// A magnitude is counted no larger (g), so that squares fit in fixed point.
    const CEILING: f64 = 7.0;

    /// Stance below `threshold_g2`, in g².
    pub fn new(threshold_g2: T) -> Self {
        Self { window: SlidingMean::new(Self::WINDOW_US), threshold_g2 }
    }
}

impl<T: Scalar> StanceDetector<T> for MovingVariance<T> {
    #[inline]
    fn update(&mut self, motion: &Motion<T>) -> Verdict<T> {
        let [x, y, z] = *motion.force_g.as_array();
        // The deviation from 1 g: its square loses fewer digits than the magnitude's.
        let deviation = (x.hypot(y).hypot(z) - T::ONE).min(T::from_f64(Self::CEILING));
        let [mean, square] = self.window.push(motion.time_us, [deviation, deviation * deviation]);
        Verdict { stance: square - mean * mean < self.threshold_g2, statistic: T::ZERO }
    }
}

/// Stance where the mean of |ω|² over 50 ms is below a threshold (angular rate energy).
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
    /// The window (µs).
    const WINDOW_US: u32 = 47_500;
    /// Largest contribution of one sample, (rad/s)².
    const CEILING: f64 = 60.0;

    /// Stance below `threshold`, in (rad/s)².
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
