use kestirim_scalar::Scalar;

/// The strength of a foot's swings: the mean of the largest SHOE statistics of the last MOST stretches of 1.4 s in
/// which it moved.
///
/// A slow walker's whole stride is slower, and so is the motion that shows that a foot does not stand, where it
/// reverses at toe-off and in the middle of the swing. Played k times as slowly, a walk has a statistic between a k²th
/// and a k⁴th.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub(crate) struct SwingLevel<T, const MOST: u16> {
    /// The beginning of the stretch (µs). It is 0 for the first, which may end with the first sample and then holds that
    /// alone.
    begun_us: u32,
    /// The largest statistic since the beginning of the stretch, (rad/s)².
    peak: T,
    /// The mean of the largest statistics, (rad/s)².
    mean: T,
    /// The number of stretches in the mean.
    count: u16,
    /// See [`Self::share`].
    share: T,
}

impl<T: Scalar, const MOST: u16> SwingLevel<T, MOST> {
    /// The length of a stretch (µs), longer than a usual stride.
    const STRIDE_US: u32 = 1_400_000;
    /// The smallest T of a swing, (rad/s)².
    const MOVES: f64 = 1.0;
    /// The level of a usual walker, (rad/s)², or less: a larger one changes nothing, and a peak counts for no more than
    /// twice this.
    const USUAL: f64 = 36.0;
    /// The smallest share: a foot that is lifted slowly also sways while it stands (two recordings by cameras).
    const LEAST: f64 = 1.0 / 6.0;

    /// Creates a level without samples.
    pub(crate) fn new() -> Self {
        Self { begun_us: 0, peak: T::ZERO, mean: T::ZERO, count: 0, share: T::ONE }
    }

    /// Adds the statistic at `time_us`.
    #[inline]
    pub(crate) fn push(&mut self, time_us: u32, statistic: T) {
        self.peak = self.peak.max(statistic);
        if time_us.wrapping_sub(self.begun_us) >= Self::STRIDE_US {
            self.end_stride(time_us);
        }
    }

    #[inline(never)] // Rare.
    fn end_stride(&mut self, time_us: u32) {
        self.begun_us = time_us;
        let peak = core::mem::replace(&mut self.peak, T::ZERO);
        if peak > T::from_f64(Self::MOVES) {
            self.count = self.count.saturating_add(1).min(MOST);
            let peak = peak.min(T::from_f64(2.0 * Self::USUAL));
            self.mean += (peak - self.mean) / T::from_binary(i32::from(self.count), 0);
            let share = self.mean * T::from_f64(1.0 / Self::USUAL);
            self.share = share.clamp(T::from_f64(Self::LEAST), T::ONE);
        }
    }

    /// The level as a share of a usual walker's, smaller for a slow walker; one before the first stride.
    #[inline(always)]
    pub(crate) fn share(&self) -> T {
        self.share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Level = SwingLevel<f64, 8>;

    /// Adds strides with a swing whose largest statistic is `peak`.
    fn walk(level: &mut Level, from_us: u32, strides: u32, peak: f64) {
        for k in 0..14 * strides {
            let statistic = if k % 14 == 7 { peak } else { 0.02 };
            level.push(from_us.wrapping_add(k * 100_000), statistic);
        }
    }

    #[test]
    fn a_usual_walker_has_all_of_it_and_a_slow_one_a_share() {
        for (peak, share) in [(300.0, 1.0), (36.1, 1.0), (18.0, 0.5), (9.0, 0.25), (2.0, 1.0 / 6.0)]
        {
            let mut level = Level::new();
            assert_eq!(level.share(), 1.0);
            walk(&mut level, u32::MAX - 3_000_000, 10, peak);
            assert!((level.share() - share).abs() < 1e-6, "{peak}: {}", level.share());
        }
    }

    #[test]
    fn standing_is_no_stride_and_one_kick_is_not_many() {
        let mut level = Level::new();
        walk(&mut level, 0, 10, 9.0);
        walk(&mut level, 14_000_000, 100, 0.9);
        assert!((level.share() - 0.25).abs() < 1e-6);
        walk(&mut level, 154_000_000, 1, 1e9);
        walk(&mut level, 155_400_000, 1, 9.0);
        assert!(level.share() < 0.5, "{}", level.share());
    }

    #[test]
    fn who_walks_faster_is_usual_within_as_many_strides() {
        let mut level = Level::new();
        walk(&mut level, 0, 10, 9.0);
        walk(&mut level, 14_000_000, 9, 80.0);
        assert!(level.share() > 0.9, "{}", level.share());
    }
}
