/// How often ranges come, and so how old one may be that is still used.
///
/// A radio that asks six anchors in turn, five times in two seconds, hears each every 2.6 s: a second, which is right where
/// ranges come in dozens, would never see three of them together.
///
/// Times are of 32 bits, because each range goes through here: they go round after 71 minutes.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Pace {
    /// Time of the newest range (µs).
    newest_us: u32,
    /// Mean time between two ranges of any anchors (µs), mostly over the last sixteen; 0 before the second.
    mean_us: u32,
    /// Number of ranges within which one of each anchor is fresh.
    fresh: u32,
    /// Anchor of the last range that was collected for a first position.
    last: Option<usize>,
}

impl Pace {
    /// Age up to which a range is always used (µs), …
    const LEAST_US: u32 = 1_000_000;
    /// … and beyond which it never is.
    pub(crate) const MOST_US: u32 = 8_000_000;
    /// An outage is not slowness: a longer interval counts as this one (µs).
    const LONGEST_US: u32 = 2_000_000;
    /// So many rounds of all anchors are fresh: one may be missed.
    const ROUNDS: u32 = 2;
    /// No range yet.
    const NEVER_US: u32 = u32::MAX / 2;

    /// Before the first range of so many anchors.
    pub(crate) const fn new(anchors: usize) -> Self {
        let fresh = (anchors as u32).saturating_mul(Self::ROUNDS);
        Self { newest_us: Self::NEVER_US, mean_us: 0, fresh, last: None }
    }

    /// Takes notice of a range.
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

    /// The first range, one after an outage, or one that is older than the newest.
    #[inline(never)] // Rare.
    fn hear_apart(&mut self, time_us: u32) {
        let is_first = self.newest_us == Self::NEVER_US;
        let is_newer = time_us.wrapping_sub(self.newest_us) as i32 > 0;
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

    /// Takes notice of a range that is collected for a first position; whether the one before was another anchor's: some
    /// radios ask each twice.
    pub(crate) fn collect(&mut self, time_us: u64, anchor: usize) -> bool {
        self.hear(time_us);
        self.last.replace(anchor) != Some(anchor)
    }

    /// Age beyond which a range is not used (µs).
    #[inline]
    pub(crate) fn fresh_us(&self) -> u64 {
        let rounds_us = self.mean_us.saturating_mul(self.fresh);
        u64::from(rounds_us.clamp(Self::LEAST_US, Self::MOST_US))
    }
}
