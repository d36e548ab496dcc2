use kestirim_health::{Health, Reason};

/// A spike is one measurement and counts as one: normalised innovations squared count for no more.
const MOST: f64 = 10.0;
/// Samples over which normalised innovations squared are averaged, exponentially, …
const NIS_MEMORY: f32 = 100.0;
/// … from so many on, …
const NIS_FIRST: u8 = 200;
/// … and what they are at most if model and noise are right. They are 1 on average, and the mean of a hundred is within
/// 1.5 with 99.9 %; noise of one and a half times what was said is no reason to doubt.
const NIS: f32 = 2.25;
/// Samples over which it is counted how many measurements were left out, exponentially, …
const LEFT_OUT_MEMORY: f32 = 25.0;
/// … and the share of them beyond which the estimate is worth less.
const LEFT_OUT: f32 = 0.1;

/// Whether measurements and model agree: averages over the last seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Monitor {
    nis: Share,
    left_out: Share,
    seen: u8,
}

impl Monitor {
    /// One that has seen nothing.
    pub(crate) const NEW: Self = Self { nis: Share::NONE, left_out: Share::NONE, seen: 0 };

    /// Counts a sample: its measurements, how many of them were left out, and what their innovations squared were in
    /// units of their variances, where a variance is known.
    pub(crate) fn count(
        &mut self,
        measured: usize,
        left_out: usize,
        nis: impl Iterator<Item = f64>,
    ) {
        let measured = measured as f32;
        let nis: f32 = nis.map(|nis| nis.min(MOST) as f32).sum();
        self.nis.count(nis, measured, NIS_MEMORY);
        self.left_out.count(left_out as f32, measured, LEFT_OUT_MEMORY);
        self.seen = self.seen.saturating_add(1);
    }

    /// What they come to.
    pub(crate) fn health(&self) -> Health {
        Health::GOOD
            .with(Reason::Rejected, self.left_out.exceeds(LEFT_OUT))
            .with(Reason::Innovations, self.seen >= NIS_FIRST && self.nis.exceeds(NIS))
    }
}

/// A sum over a number of things, both fading.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Share {
    sum: f32,
    of: f32,
}

impl Share {
    const NONE: Self = Self { sum: 0.0, of: 0.0 };

    fn count(&mut self, sum: f32, of: f32, memory: f32) {
        let keep = 1.0 - 1.0 / memory;
        self.sum = keep * self.sum + sum;
        self.of = keep * self.of + of;
    }

    fn exceeds(self, share: f32) -> bool {
        self.sum > share * self.of
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_large_innovations_are_doubted_once_there_are_enough_of_them() {
        let mut monitor = Monitor::default();
        let mut count = |nis: f64, lines: usize| {
            (0..lines).for_each(|_| monitor.count(3, 0, [nis; 3].into_iter()));
            monitor.health()
        };
        assert_eq!(count(12.0, 100), Health::GOOD, "an estimate converges");
        assert_eq!(count(1.0, 400), Health::GOOD);
        assert_eq!(count(4.0, 30), Health::GOOD);
        assert_eq!(count(4.0, 60), Reason::Innovations.into());
        assert_eq!(count(1.0, 400), Health::GOOD);
    }

    #[test]
    fn what_is_left_out_is_doubted_while_it_is_much() {
        let mut monitor = Monitor::default();
        let mut count = |left_out: usize, lines: usize| {
            (0..lines).for_each(|_| monitor.count(2, left_out, [1.0; 2].into_iter()));
            monitor.health()
        };
        assert_eq!(count(0, 100), Health::GOOD);
        assert_eq!(count(1, 1), Health::GOOD, "a spike");
        assert_eq!(count(1, 19), Reason::Rejected.into());
        assert_eq!(count(0, 50), Health::GOOD);
    }
}
