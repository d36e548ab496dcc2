use kestirim_scalar::Scalar;

/// How strongly a foot swings: the mean of the largest SHOE statistics of 1.4 s each, of those in which it moved.
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
pub(crate) struct SwingLevel<T> {
    begun_us: u32,
    /// The largest since then, (rad/s)².
    peak: T,
    /// The mean, (rad/s)².
    mean: T,
    /// How many it is of, no more than `most`.
    count: u16,
    most: u16,
    share: T,
}

impl<T: Scalar> SwingLevel<T> {
    /// No stride is longer, but of who hardly walks (µs).
    const STRIDE_US: u32 = 1_400_000;
    /// Largest T below which a foot does not swing, (rad/s)².
    const MOVES: f64 = 1.0;
    /// A usual walker's, (rad/s)², from which on a level is all one; nothing larger than twice that counts.
    const USUAL: f64 = 36.0;
    /// A foot that is hardly lifted turns and sways where it stands, too.
    const LEAST: f64 = 1.0 / 6.0;

    /// A mean of about the last `most`.
    pub(crate) fn of_last(most: u16) -> Self {
        Self {
            begun_us: 0,
            peak: T::ZERO,
            mean: T::ZERO,
            count: 0,
            most: most.max(1),
            share: T::ONE,
        }
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
        // Of a window that is not full it is the largest number.
        if peak > T::from_f64(Self::MOVES) && peak < T::MAX {
            self.count = self.count.saturating_add(1).min(self.most);
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

    /// Strides with a swing whose largest statistic is this.
    fn walk(level: &mut SwingLevel<f64>, from_us: u32, strides: u32, peak: f64) {
        for k in 0..14 * strides {
            let statistic = if k % 14 == 7 { peak } else { 0.02 };
            level.push(from_us.wrapping_add(k * 100_000), statistic);
        }
    }

    #[test]
    fn a_usual_walker_has_all_of_it_and_a_slow_one_a_share() {
        for (peak, share) in [(300.0, 1.0), (36.1, 1.0), (18.0, 0.5), (9.0, 0.25), (2.0, 1.0 / 6.0)]
        {
            let mut level = SwingLevel::of_last(8);
            assert_eq!(level.share(), 1.0);
            walk(&mut level, u32::MAX - 3_000_000, 10, peak);
            assert!((level.share() - share).abs() < 1e-6, "{peak}: {}", level.share());
        }
    }

    #[test]
    fn standing_is_no_stride_and_one_kick_is_not_many() {
        let mut level = SwingLevel::of_last(8);
        walk(&mut level, 0, 10, 9.0);
        walk(&mut level, 14_000_000, 100, 0.9);
        assert!((level.share() - 0.25).abs() < 1e-6);
        walk(&mut level, 154_000_000, 1, 1e9);
        walk(&mut level, 155_400_000, 1, 9.0);
        assert!(level.share() < 0.5, "{}", level.share());
    }

    #[test]
    fn who_walks_faster_is_usual_within_as_many_strides() {
        let mut level = SwingLevel::of_last(8);
        walk(&mut level, 0, 10, 9.0);
        walk(&mut level, 14_000_000, 9, 80.0);
        assert!(level.share() > 0.9, "{}", level.share());
    }
}
