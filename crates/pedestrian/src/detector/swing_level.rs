use kestirim_scalar::Scalar;

/// How strongly a foot swings: the mean of the largest SHOE statistic of each 1.4 s in which it moved, of the last MOST of them.
///
/// Of a slow walker all of a stride is slower: so is what shows that a foot does not stand, where it turns back at toe-off and in the
/// middle of the swing. Played k times as slow, a walk's statistic is between a k²th and a k⁴th.
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
    /// Of the first stretch it is 0: what came before the first sample is no stretch, or ends with it.
    begun_us: u32,
    /// The largest since then, (rad/s)².
    peak: T,
    /// The mean, (rad/s)².
    mean: T,
    /// How many it is of.
    count: u16,
    /// See [`Self::share`].
    share: T,
}

impl<T: Scalar, const MOST: u16> SwingLevel<T, MOST> {
    /// A usual stride is shorter (µs).
    const STRIDE_US: u32 = 1_400_000;
    /// Largest T below which a foot does not swing, (rad/s)².
    const MOVES: f64 = 1.0;
    /// A usual walker's level, (rad/s)², or less. A larger one changes nothing, and a peak counts for no more than twice this.
    const USUAL: f64 = 36.0;
    /// The least share: a foot that is lifted slowly sways where it stands, too (two recordings by cameras).
    const LEAST: f64 = 1.0 / 6.0;

    /// Before the first sample.
    pub(crate) fn new() -> Self {
        Self { begun_us: 0, peak: T::ZERO, mean: T::ZERO, count: 0, share: T::ONE }
    }

    /// Takes the statistic at `time_us`.
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
        // While a window is not full, at first and after a gap, the statistic is the largest number: such a stretch does not count.
        if peak > T::from_f64(Self::MOVES) && peak < T::MAX {
            self.count = self.count.saturating_add(1).min(MOST);
            let peak = peak.min(T::from_f64(2.0 * Self::USUAL));
            self.mean += (peak - self.mean) / T::from_binary(i32::from(self.count), 0);
            let share = self.mean * T::from_f64(1.0 / Self::USUAL);
            self.share = share.clamp(T::from_f64(Self::LEAST), T::ONE);
        }
    }

    /// The level as a share of a usual walker's, of which a slow one has less; before the first stride, all of it.
    #[inline(always)]
    pub(crate) fn share(&self) -> T {
        self.share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Level = SwingLevel<f64, 8>;

    /// Strides with a swing whose largest statistic is this.
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
    fn a_stretch_with_a_window_that_is_not_full_does_not_count() {
        let mut level = Level::new();
        level.push(7_000_000, f64::MAX);
        walk(&mut level, 7_010_000, 2, 9.0);
        assert!((level.share() - 0.25).abs() < 1e-6, "{}", level.share());
        level.push(9_900_000, 0.02);
        for (time_us, statistic) in
            [(10_000_000, f64::MAX), (10_500_000, 300.0), (11_400_000, 0.02)]
        {
            level.push(time_us, statistic);
        }
        assert!((level.share() - 0.25).abs() < 1e-6, "{}", level.share());
    }

    #[test]
    fn who_walks_faster_is_usual_within_as_many_strides() {
        let mut level = Level::new();
        walk(&mut level, 0, 10, 9.0);
        walk(&mut level, 14_000_000, 9, 80.0);
        assert!(level.share() > 0.9, "{}", level.share());
    }
}
