use super::{Motion, Shoe, StanceDetector, SwingLevel, Verdict};
use kestirim_scalar::Scalar;

/// The default detector: SHOE without a threshold to choose.
///
/// Every stride has a stance, so the smallest T of the last 1.4 s belongs to one, for any walker: the foot stands where
/// T < max(T₀, 2·min T), with a smaller T₀ for slow walkers. If no stance is found for a while, the walker has begun to
/// run or the minimum was that of a standstill, and the bound grows with the time since. For the first 1.4 s, and after a gap of
/// 0.7 s, only T₀ counts: the smallest T so far may be in a swing.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: Copy + serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Adaptive<T> {
    shoe: Shoe<T>,
    minimum: RecentMinimum<T>,
    swing: SwingLevel<T, 8>,
    last_stance_us: Option<u32>,
}

impl<T: Scalar> Default for Adaptive<T> {
    fn default() -> Self {
        Self {
            shoe: Shoe::default(),
            minimum: RecentMinimum::new(Self::MEMORY_BINS),
            swing: SwingLevel::new(),
            last_stance_us: None,
        }
    }
}

impl<T: Scalar> Adaptive<T> {
    /// The memory of the minimum, in bins: 1.4 s, longer than a slow stride.
    const MEMORY_BINS: usize = 14;
    /// The threshold as a multiple of the smallest T; any value from 1.5 to 3 finds the same strides.
    const FACTOR: f64 = 2.0;
    /// T₀, (rad/s)²: below 0.3 rad/s the foot of a usual walker always stands.
    const FLOOR: f64 = 0.1;
    /// The time after a stance at which the bound begins to grow (µs), by three times its value per second.
    const PATIENCE_US: u32 = 500_000;
    /// The longest time for which the bound grows (µs).
    const IMPATIENCE_US: u32 = 10_000_000;

    /// The bound from the smallest statistic and the time since a stance (µs): no less than `floor`.
    #[inline]
    fn bound(&self, floor: T, minimum: T, since: u32) -> T {
        let mut bound = floor;
        if self.minimum.is_full() {
            bound = bound.max(minimum * T::from_f64(Self::FACTOR));
        }
        if since > Self::PATIENCE_US {
            let waited = (since - Self::PATIENCE_US).min(Self::IMPATIENCE_US);
            bound += bound * T::from_micro(3 * waited as i32);
        }
        bound
    }
}

impl<T: Scalar> StanceDetector<T> for Adaptive<T> {
    #[inline]
    fn update(&mut self, motion: &Motion<T>) -> Verdict<T> {
        let statistic = self.shoe.update(motion);
        let minimum = self.minimum.push(motion.time_us, statistic);
        let last_us = *self.last_stance_us.get_or_insert(motion.time_us);
        let since = motion.time_us.wrapping_sub(last_us);
        self.swing.push(motion.time_us, statistic);
        let floor = self.swing.share() * T::from_f64(Self::FLOOR);
        let stance = statistic < floor || statistic < self.bound(floor, minimum, since);
        if stance {
            self.last_stance_us = Some(motion.time_us);
        }
        Verdict { stance, statistic }
    }
}

/// The largest number of bins.
const CAPACITY: usize = 16;

/// The smallest value of the recent past, in bins of a tenth of a second.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct RecentMinimum<T> {
    bins: [T; CAPACITY],
    #[cfg_attr(
        feature = "serde",
        serde(deserialize_with = "kestirim_snapshot::arrays::index::<_, CAPACITY>")
    )]
    newest: usize,
    begun_us: Option<u32>,
    /// The smallest value of all bins except the newest.
    older: T,
    #[cfg_attr(
        feature = "serde",
        serde(deserialize_with = "kestirim_snapshot::arrays::count::<_, { CAPACITY - 1 }>")
    )]
    memory: usize,
    /// Bins since the first value, or since a gap of half as many; at most `memory`.
    #[cfg_attr(
        feature = "serde",
        serde(deserialize_with = "kestirim_snapshot::arrays::count::<_, { CAPACITY - 1 }>")
    )]
    passed: usize,
}

impl<T> RecentMinimum<T> {
    /// The length of a bin (µs).
    pub(crate) const BIN_US: u32 = 100_000;
}

impl<T: Scalar> RecentMinimum<T> {
    /// Creates a memory of `memory` bins, at most 15, besides the one being filled.
    pub(crate) fn new(memory: usize) -> Self {
        Self {
            bins: [T::MAX; CAPACITY],
            newest: 0,
            begun_us: None,
            older: T::MAX,
            memory: memory.min(CAPACITY - 1),
            passed: 0,
        }
    }

    /// Adds the value at `time_us` and returns the smallest that is kept.
    #[inline]
    pub(crate) fn push(&mut self, time_us: u32, value: T) -> T {
        let begun_us = *self.begun_us.get_or_insert(time_us);
        if time_us.wrapping_sub(begun_us) >= Self::BIN_US {
            self.next_bin(begun_us, time_us);
        }
        let bin = &mut self.bins[self.newest % CAPACITY];
        *bin = bin.min(value);
        self.smallest()
    }

    /// The smallest value that is kept.
    #[inline]
    pub(crate) fn smallest(&self) -> T {
        self.bins[self.newest % CAPACITY].min(self.older)
    }

    /// Whether it has lasted for all of its bins.
    #[inline]
    pub(crate) fn is_full(&self) -> bool {
        self.passed >= self.memory
    }

    /// Begins the bin that contains `time_us`; skipped bins stay empty.
    #[inline(never)]
    fn next_bin(&mut self, mut begun_us: u32, time_us: u32) {
        // A long gap empties every bin, and no more than these need to be passed.
        let mut skipped = 0;
        for bin in 0..CAPACITY {
            self.newest = (self.newest + 1) % CAPACITY;
            self.bins[self.newest] = T::MAX;
            self.passed = (self.passed + 1).min(self.memory);
            begun_us = begun_us.wrapping_add(Self::BIN_US);
            skipped = bin;
            if time_us.wrapping_sub(begun_us) < Self::BIN_US {
                break;
            }
        }
        // What half of the bins do not tell is not known.
        if 2 * skipped >= self.memory {
            self.passed = 0;
        }
        let inside = time_us.wrapping_sub(begun_us) < Self::BIN_US;
        self.begun_us = Some(if inside { begun_us } else { time_us });
        self.older = (1..=self.memory).fold(T::MAX, |smallest, age| {
            smallest.min(self.bins[self.newest.wrapping_sub(age) % CAPACITY])
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SVector;

    const BIN_US: u32 = RecentMinimum::<f64>::BIN_US;

    #[test]
    fn a_minimum_is_kept_for_so_many_bins() {
        let bins = 5;
        let mut minimum = RecentMinimum::new(bins);
        assert_eq!(minimum.push(1_000, 1.0), 1.0);
        let mut forgotten = None;
        for k in 1..200_u32 {
            let time_us = 1_000 + k * 10_000;
            if minimum.push(time_us, 5.0) == 5.0 {
                forgotten = forgotten.or(Some(time_us));
            }
        }
        // Including the bin being filled: a value is forgotten when the sixth bin after its own begins.
        assert_eq!(forgotten, Some(1_000 + 6 * BIN_US));
        assert_eq!(minimum.smallest(), 5.0);
        assert_eq!(minimum.push(2_000_000, 0.5), 0.5);
        assert_eq!(minimum.push(2_000_000, 0.7), 0.5);
    }

    #[test]
    fn bins_are_passed_over_in_a_gap() {
        for (gap_us, kept) in [(3 * BIN_US, true), (5 * BIN_US, true), (6 * BIN_US, false)] {
            let mut minimum = RecentMinimum::new(5);
            minimum.push(u32::MAX - 50_000, 1.0);
            let found = minimum.push((u32::MAX - 50_000).wrapping_add(gap_us), 5.0);
            assert_eq!(found == 1.0, kept, "{gap_us} µs");
        }
        // A long gap empties all bins, and the next bin begins at its end.
        let mut minimum = RecentMinimum::new(15);
        minimum.push(0, 1.0);
        (1..=15).for_each(|bin| assert_eq!(minimum.push(bin * BIN_US, 1.0), 1.0));
        assert!(minimum.is_full());
        assert_eq!(minimum.push(3_600_000_000, 5.0), 5.0);
        assert!(!minimum.is_full());
        assert_eq!(minimum.push(3_600_000_000 + BIN_US - 1, 4.0), 4.0);
        assert_eq!(minimum.push(3_600_000_000 + 16 * BIN_US - 1, 9.0), 4.0);
        assert_eq!(minimum.push(3_600_000_000 + 16 * BIN_US, 9.0), 9.0);
    }

    #[test]
    fn a_foot_seen_first_in_its_swing_does_not_stand() {
        let mut detector = Adaptive::default();
        // It slows down to 1 rad/s, and swings again.
        for k in 0..60 {
            let rate = 1.0 + 0.1 * (k as f64 - 30.0).abs();
            assert!(!turning(&mut detector, k * 10_000, rate), "{k}");
        }
    }

    #[test]
    fn a_swing_after_a_gap_is_no_stance() {
        for gap in 8..=20 {
            let mut detector = Adaptive::default();
            // Strides of a second, with a stance of a third.
            for k in 0..300 {
                let rate = if k % 100 < 33 { 0.0 } else { 4.0 };
                turning(&mut detector, k * 10_000, rate);
            }
            let begin = 3_000_000 + gap * BIN_US;
            for k in 0..30 {
                let rate = 5.0 - 0.05 * f64::from(k);
                assert!(!turning(&mut detector, begin + k * 10_000, rate), "{gap}: {k}");
            }
        }
    }

    /// Processes a foot that turns at this rate (rad/s) at a time (µs).
    fn turning(detector: &mut Adaptive<f64>, time_us: u32, rate: f64) -> bool {
        let force_g = SVector::from([0.0, 0.0, 1.0]);
        let angular_rate = SVector::from([rate, 0.0, 0.0]);
        detector.update(&Motion { time_us, force_g, angular_rate }).stance
    }

    #[test]
    fn the_bound_grows_fourfold_in_the_second_after_half_of_one_without_a_stance() {
        for (waited, grown) in [(0.3, 1.0), (0.5, 1.0), (1.5, 4.0), (2.5, 7.0), (60.0, 31.0)] {
            for (share, stands) in [(0.97, true), (1.03, false)] {
                let mut detector = Adaptive::default();
                // The squared rate is 1 and never less.
                for k in 0..20 {
                    turning(&mut detector, k * 10_000, 1.0);
                }
                // Then it is unseen for a while, with a stance just before the end.
                detector.last_stance_us = Some(190_000);
                let time_us = 190_000 + (waited * 1e6) as u32;
                detector.minimum = RecentMinimum::new(Adaptive::<f64>::MEMORY_BINS);
                detector.minimum.passed = Adaptive::<f64>::MEMORY_BINS;
                detector.minimum.push(time_us, 0.5);
                // Then it turns faster: twice the smallest is the bound.
                let rate = (grown * share).sqrt();
                assert_eq!(turning(&mut detector, time_us, rate), stands, "{waited} s, {share}");
            }
        }
    }

    #[test]
    fn below_a_third_of_a_radian_a_second_a_foot_always_stands() {
        let mut detector = Adaptive::default();
        for k in 0..100 {
            assert!(turning(&mut detector, k * 10_000, 0.0));
        }
        for (rate, stands) in [(0.31, true), (0.33, false)] {
            let mut detector = detector;
            let all = (100..106).map(|k| turning(&mut detector, k * 10_000, rate));
            assert_eq!(all.last(), Some(stands), "{rate} rad/s");
        }
    }
}
