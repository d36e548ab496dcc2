use super::window::SlidingMean;
use super::{Motion, StanceDetector, Verdict};
use kestirim_scalar::{Components, Scalar};

/// The statistic of the stance hypothesis optimal estimator (Skog et al., IEEE TBME 2010, eq. 14) over 50 ms.
///
/// T = mean |ω|² + κ·mean |f − f̄/|f̄||², with f in units of g: the deviation of the last 50 ms from a foot that does
/// not turn and senses only gravity. Its unit is (rad/s)²; κ = 2.9 (rad/s)² weighs 0.1 g like 0.17 rad/s.
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
    /// The length of the window (µs): 30 to 100 ms give the same walks; stances in running last 100 ms.
    pub(crate) const WINDOW_US: u32 = 47_500;
    /// The weight κ of the force, (rad/s)² per g².
    const FORCE_WEIGHT: f64 = 2.885;
    /// The largest contribution of one sample, far beyond any stance, so that the sums stay small in fixed point.
    const CEILING: f64 = 60.0;

    /// Processes the next sample and returns T.
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
        // |f̄| − 1 = (|f̄|² − 1)/(|f̄| + 1), near a stance half of the numerator, which saves a square root.
        let excess = (mean_square - T::ONE) * T::HALF;
        let spread = (force_square - mean_square).max(T::ZERO);
        rate_square.max(T::ZERO) + T::from_f64(Self::FORCE_WEIGHT) * (spread + excess * excess)
    }
}

/// A detector of stance where T is below a fixed threshold.
///
/// It suits one walker on one day: on other walks the same threshold loses stances or finds them in slow swings.
/// [`Adaptive`](super::Adaptive) needs no threshold.
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

    /// Creates a detector of stance below `threshold`, in (rad/s)².
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

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SVector;

    /// T of a foot after a tenth of a second of a force (g) and rate (rad/s) per sample.
    fn statistic(motion: impl Fn(usize) -> ([f64; 3], [f64; 3])) -> f64 {
        let mut shoe = Shoe::default();
        let mut last = 0.0;
        for k in 0..40 {
            let (force_g, rate) = motion(k);
            let (force_g, angular_rate) = (SVector::from(force_g), SVector::from(rate));
            last = shoe.update(&Motion { time_us: k as u32 * 2_500, force_g, angular_rate });
        }
        last
    }

    #[test]
    fn a_foot_at_rest_shows_nothing_however_it_lies() {
        assert!(statistic(|_| ([0.0, 0.6, -0.8], [0.0; 3])) < 1e-12);
    }

    #[test]
    fn the_statistic_is_the_published_one() {
        assert!((statistic(|_| ([0.0, 0.6, 0.8], [0.2, -0.1, 0.4])) - 0.21).abs() < 1e-9);
        // A force that shakes by 0.1 g across gravity: κ times its square.
        let shaken = statistic(|k| ([if k % 2 == 0 { 0.1 } else { -0.1 }, 0.0, 1.0], [0.0; 3]));
        assert!((shaken / (2.885 * 0.01) - 1.0).abs() < 0.03, "{shaken}");
        // A force a little larger or smaller than gravity: κ times the square of the difference.
        for force in [1.02, 0.98] {
            let found = statistic(|_| ([0.0, force, 0.0], [0.0; 3]));
            assert!((found / (2.885 * 0.02 * 0.02) - 1.0).abs() < 0.03, "{force} g: {found}");
        }
    }

    #[test]
    fn one_sample_contributes_no_more_than_fits_into_fixed_point() {
        let turned = statistic(|k| ([0.0, 0.0, 1.0], [if k == 39 { 1e6 } else { 0.0 }, 0.0, 0.0]));
        assert!((turned - 60.0 / 19.0).abs() < 1e-6, "{turned}");
        let hit = statistic(|k| ([0.0, 0.0, if k == 20 { 1e3 } else { 1.0 }], [0.0; 3]));
        assert!(hit < 1e-6, "{hit}: it is out of the window");
    }

    #[test]
    fn a_fixed_threshold_is_one() {
        let mut detector = FixedShoe::new(0.5);
        for (rate, stance) in [(0.7, true), (0.72, false), (0.0, true)] {
            let (mut verdict, angular_rate) = (None, SVector::from([rate, 0.0, 0.0]));
            for k in 0..20 {
                let force_g = SVector::from([0.0, 0.0, 1.0]);
                verdict =
                    Some(detector.update(&Motion { time_us: k * 10_000, force_g, angular_rate }));
            }
            let verdict = verdict.expect("samples");
            assert!((verdict.statistic - rate * rate).abs() < 1e-9, "{verdict:?}");
            assert_eq!(verdict.stance, stance, "{rate} rad/s");
        }
    }
}
