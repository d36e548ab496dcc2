use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// Tells standing from moving by the energy of an accelerometer's changes.
///
/// The acceleration's deviation from its own mean over the last half second is squared and averaged
/// over the last 0.15 s. Whatever is constant, gravity or a bias, does not matter. A robot's wheels
/// shake it by half a metre per second squared even at walking snails' pace; a standing one shows
/// the sensor's noise.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Stillness<T: Scalar> {
    last_us: Option<u64>,
    mean: SVector<T, 3>,
    variance: T,
    calm: bool,
    /// When it was last jolted (µs); if it ever was.
    jolted_us: Option<u64>,
}

impl<T: Scalar> Stillness<T> {
    /// Root mean square of the changes below which the tag stands, m/s².
    const LIMIT: f64 = 0.3;
    /// Time over which the mean is taken, s.
    const MEAN_TIME: f64 = 0.5;
    /// Time over which the squares are averaged, s.
    const SQUARE_TIME: f64 = 0.15;
    /// Root mean square of the changes in a step, m/s².
    const JOLT: f64 = 1.0;
    /// Time after a jolt before which nothing is believed to stand (µs): longer than a step.
    const STEP_US: u64 = 700_000;
    /// Longest gap between samples after which stillness is still known (µs).
    const GAP_US: u64 = 500_000;

    pub(crate) fn new() -> Self {
        Self {
            last_us: None,
            mean: SVector::zeros(),
            variance: T::ONE,
            calm: false,
            jolted_us: None,
        }
    }

    /// Whether the tag stands at `time_us`.
    #[inline]
    pub(crate) fn is_still(&self, time_us: u64) -> bool {
        let fresh = |last_us| time_us.saturating_sub(last_us) <= Self::GAP_US;
        let settled = |jolted_us| time_us.saturating_sub(jolted_us) >= Self::STEP_US;
        self.calm && self.last_us.is_some_and(fresh) && self.jolted_us.is_none_or(settled)
    }

    /// Takes in what the accelerometer shows and, where it is known, how strongly it is pushed: a steady push
    /// looks like gravity, but is not rest.
    #[inline]
    pub(crate) fn update(&mut self, time_us: u64, acceleration: &SVector<T, 3>, push: T) {
        let elapsed = self.last_us.map(|last_us| time_us.saturating_sub(last_us));
        self.last_us = Some(time_us);
        let Some(elapsed) = elapsed.filter(|&elapsed| elapsed <= Self::GAP_US) else {
            *self = Self { last_us: Some(time_us), mean: *acceleration, ..Self::new() };
            return;
        };
        let dt = T::from_micro(elapsed as i32);
        let deviation = acceleration - self.mean;
        let share = |time: T| dt / (time + dt);
        self.mean += deviation * share(T::from_f64(Self::MEAN_TIME));
        // Beyond a few metres per second squared it moves, however much: the square stays in range.
        let size = T::norm(deviation.as_array()).min(T::TWO);
        self.variance += (size * size - self.variance) * share(T::from_f64(Self::SQUARE_TIME));
        let calm = self.variance < T::from_f64(Self::LIMIT * Self::LIMIT);
        self.calm = calm && push < T::from_f64(Self::LIMIT);
        if self.variance > T::from_f64(Self::JOLT * Self::JOLT) {
            self.jolted_us = Some(time_us);
        }
    }
}
