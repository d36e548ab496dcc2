use super::window::SlidingMean;
use super::{Motion, StanceDetector, Verdict};
use kestirim_scalar::{Components, Scalar};

/// The statistic of the stance hypothesis optimal estimator (Skog et al., IEEE TBME 2010, eq. 14) over 50 ms.
///
/// T = mean |ω|² + κ·mean |f − f̄/|f̄||², with f in units of g: how far the last 50 ms are from a foot that
/// does not turn and feels gravity alone. Its unit is (rad/s)²; κ = 2.9 (rad/s)² weighs 0.1 g like 0.17 rad/s.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: Copy + serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Shoe<T> {
    window: SlidingMean<T, 5>,
}

impl<T: Scalar> Default for Shoe<T> {
    fn default() -> Self {
        Self { window: SlidingMean::new(Self::WINDOW_US) }
    }
}

impl<T: Scalar> Shoe<T> {
    /// The window (µs). 30 to 100 ms give the same walks; stances of running last 100 ms.
    pub(crate) const WINDOW_US: u32 = 47_500;
    /// κ, (rad/s)² per g².
    const FORCE_WEIGHT: f64 = 2.885;
    /// Largest contribution of one sample, so that the sums stay small in fixed point: far beyond any stance.
    const CEILING: f64 = 60.0;

    /// Takes the next sample and returns T.
    #[inline]
    pub fn update(&mut self, motion: &Motion<T>) -> T {
        let ceiling = T::from_f64(Self::CEILING);
        let [x, y, z] = *motion.force_g.as_array();
        let force_square = T::dot(&[x, y, z], &[x, y, z]).min(ceiling);
        let rate = motion.angular_rate.as_array();
        let rate_square = T::dot(rate, rate).min(ceiling);
        let [x, y, z, force_square, rate_square] =
            self.window.push(motion.time_us, [x, y, z, force_square, rate_square]);
        let mean_square = T::dot(&[x, y, z], &[x, y, z]);
        // |f̄| − 1 = (|f̄|² − 1)/(|f̄| + 1), near a stance half of the numerator: no square root.
        let excess = (mean_square - T::ONE) * T::HALF;
        let spread = (force_square - mean_square).max(T::ZERO);
        rate_square.max(T::ZERO) + T::from_f64(Self::FORCE_WEIGHT) * (spread + excess * excess)
    }
}

/// Stance where T is below a fixed threshold.
///
/// Right for one walker on one day: on other walks the same threshold loses stances or finds them in
/// slow swings. [`Adaptive`](super::Adaptive) needs none.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: Copy + serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct FixedShoe<T> {
    shoe: Shoe<T>,
    threshold: T,
}

impl<T: Scalar> FixedShoe<T> {
    /// The default threshold, (rad/s)².
    pub const THRESHOLD: f64 = 0.5;

    /// Stance below `threshold`, in (rad/s)².
    pub fn new(threshold: T) -> Self {
        Self { shoe: Shoe::default(), threshold }
    }
}

impl<T: Scalar> StanceDetector<T> for FixedShoe<T> {
    #[inline]
    fn update(&mut self, motion: &Motion<T>) -> Verdict<T> {
        let statistic = self.shoe.update(motion);
        Verdict { stance: statistic < self.threshold, statistic }
    }
}
