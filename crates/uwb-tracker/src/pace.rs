/// The rate at which ranges arrive, which determines how old a range may be to be used.
///
/// A radio that polls six anchors in turn, with five ranges in two seconds, hears each every 2.6 s: with a limit of
/// one second, which is right where ranges come in dozens, three of them would never be fresh together.
///
/// Times have 32 bits, because each range is processed here: they wrap after 71 minutes.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Pace {
    /// Time of the newest range, µs.
    newest_us: u32,
    /// Mean time between two ranges of any anchors, mostly over the last sixteen, µs; 0 before the second range.
    mean_us: u32,
    /// Number of successive ranges within which each anchor's is fresh.
    fresh: u32,
    /// Anchor of the last range that was collected for a first position.
    last: Option<usize>,
}

impl Pace {
    /// Age up to which a range is always used, µs.
    const LEAST_US: u32 = 1_000_000;
    /// Age beyond which a range is never used, µs.
    pub(crate) const MOST_US: u32 = 8_000_000;
    /// Limit of the interval between ranges, µs: an outage does not mean a slow radio.
    const LONGEST_US: u32 = 2_000_000;
    /// Largest interval between two ranges of a fast radio, µs.
    const FAST_US: u32 = 110_000;
    /// Number of rounds of all anchors that are fresh: one may be missed.
    const ROUNDS: u32 = 2;
    /// Marks the state before the first range.
    const NEVER_US: u32 = u32::MAX / 2;

    /// Creates the state before the first range, for this number of anchors.
    pub(crate) const fn new(anchors: usize) -> Self {
        let fresh = (anchors as u32).saturating_mul(Self::ROUNDS);
        Self { newest_us: Self::NEVER_US, mean_us: 0, fresh, last: None }
    }

    /// Records the arrival of a range.
    #[inline(always)]
    pub(crate) fn hear(&mut self, time_us: u64) {
        let interval_us = (time_us as u32).wrapping_sub(self.newest_us);
        if interval_us <= Self::LONGEST_US {
            self.newest_us = time_us as u32;
            self.learn(interval_us);
        } else {
            self.hear_apart(time_us as u32);
        }
    }

    /// Records the first range, one after an outage, or one that is older than the newest.
    #[inline(never)] // Rare.
    fn hear_apart(&mut self, time_us: u32) {
        let is_first = self.newest_us == Self::NEVER_US;
        // A range older than any that is used is not late: the outage lasted for most of the clock's period.
        let is_newer = self.newest_us.wrapping_sub(time_us) > Self::MOST_US;
        if !is_first {
            self.learn(if is_newer { Self::LONGEST_US } else { 0 });
        }
        if is_newer || is_first {
            self.newest_us = time_us;
        }
    }

    #[inline(always)]
    fn learn(&mut self, interval_us: u32) {
        self.mean_us = if self.mean_us == 0 {
            interval_us
        } else {
            self.mean_us - (self.mean_us >> 4) + (interval_us >> 4)
        };
    }

    /// Records a range that is collected for a first position. Returns whether the previous one was of another anchor:
    /// some radios poll each anchor twice.
    pub(crate) fn collect(&mut self, time_us: u64, anchor: usize) -> bool {
        self.hear(time_us);
        self.last.replace(anchor) != Some(anchor)
    }

    /// Factor by which the time until the next range exceeds that of a fast radio: a search that is not finished
    /// within seconds would restart again and again.
    pub(crate) fn leisure(&self) -> usize {
        1 + (self.mean_us / Self::FAST_US).min(20) as usize
    }

    /// Age beyond which a range is not used, µs.
    #[inline]
    pub(crate) fn fresh_us(&self) -> u64 {
        let rounds_us = self.mean_us.saturating_mul(self.fresh);
        u64::from(rounds_us.clamp(Self::LEAST_US, Self::MOST_US))
    }
}

#[cfg(test)]
mod tests {
    use super::Pace;

    /// The pace of six anchors heard in turn, at these times (µs).
    fn heard(times_us: impl IntoIterator<Item = u64>) -> Pace {
        let mut pace = Pace::new(6);
        times_us.into_iter().for_each(|time_us| pace.hear(time_us));
        pace
    }

    #[test]
    fn two_rounds_of_the_anchors_are_fresh_within_bounds() {
        for (interval_us, fresh_us) in
            [(10_000, 1_000_000), (100_000, 1_200_000), (400_000, 4_800_000), (900_000, 8_000_000)]
        {
            for count in [2, 100] {
                let pace = heard((1..=count).map(|k| k * interval_us));
                assert_eq!(pace.fresh_us(), fresh_us, "{count} ranges every {interval_us} µs");
            }
        }
        for time_us in [500_000, 5_000_000] {
            assert_eq!(heard([time_us]).fresh_us(), 1_000_000, "of one range");
        }
    }

    #[test]
    fn another_pace_is_learnt_in_sixteen_ranges() {
        let (quick, slow) = ((1..50).map(|k| k * 100_000), (1..=16).map(|k| k * 600_000));
        let pace = heard(quick.chain(slow.map(|us| us + 4_900_000)));
        // 1 − 1/e of the way from 1.2 to 7.2 s, or slightly more.
        let learnt = (pace.fresh_us() as f64 - 1.2e6) / 6e6;
        assert!((0.6..0.7).contains(&learnt), "{learnt}");
    }

    #[test]
    fn an_outage_counts_as_two_seconds() {
        let times_us = [0, 400_000, 800_000];
        for outage_us in [2_000_000, 2_000_001, 3_600_000_000] {
            let pace = heard(times_us.into_iter().chain([800_000 + outage_us]));
            // A sixteenth of the way from 0.4 to 2 s.
            assert_eq!(pace.fresh_us(), 6_000_000, "{outage_us} µs");
            // It continues from there.
            let end_us = 800_000 + outage_us;
            let pace = heard(times_us.into_iter().chain([end_us, end_us + 500_000]));
            assert_eq!(pace.fresh_us(), 6_000_000, "{outage_us} µs");
        }
    }

    #[test]
    fn a_range_that_is_late_is_no_interval() {
        let late = heard([0, 400_000, 800_000, 500_000]);
        assert_eq!(late.fresh_us(), 4_500_000);
        let times_us = [8_000_000, 8_400_000, 8_800_000];
        assert_eq!(heard(times_us.into_iter().chain([800_000])).fresh_us(), 4_500_000);
        // Older ranges are not used at all.
        assert_eq!(heard(times_us.into_iter().chain([799_999])).fresh_us(), 6_000_000);
        // The next interval is counted from the newest range.
        let next = heard([0, 400_000, 800_000, 500_000, 1_175_000]);
        assert_eq!(next.fresh_us(), 4_500_000);
    }

    #[test]
    fn a_clock_of_32_bits_goes_round() {
        let begin_us = u64::from(u32::MAX) - 1_000_000;
        let pace = heard((0..50).map(|k| begin_us + k * 400_000));
        assert_eq!(pace.fresh_us(), 4_800_000);
    }

    #[test]
    fn ranges_of_one_anchor_in_a_row_are_told() {
        let mut pace = Pace::new(6);
        let others = [3, 3, 1, 3].map(|anchor| pace.collect(0, anchor));
        assert_eq!(others, [true, false, true, true]);
        assert_eq!(pace.fresh_us(), heard([0; 4]).fresh_us());
        pace.collect(400_000, 1);
        assert_eq!(pace.fresh_us(), 4_800_000, "they count as heard");
    }
}
