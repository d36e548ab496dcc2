use kestirim_health::{Health, Reason};

/// Limit of a normalised innovation squared, so that a spike counts as a single measurement.
const MOST: f64 = 10.0;
/// Number of samples over which normalised innovations squared are averaged exponentially.
const NIS_MEMORY: f32 = 100.0;
/// Number of samples from which this average is judged.
const NIS_FIRST: u8 = 200;
/// Largest mean normalised innovation squared if model and noise are right. It is 1 on average, and the mean of a
/// hundred is below 1.5 with 99.9 %; noise of one and a half times the specified level is not reported.
const NIS: f32 = 2.25;
/// Number of samples over which the share of rejected measurements is averaged exponentially.
const LEFT_OUT_MEMORY: f32 = 25.0;
/// Share of rejected measurements beyond which the estimate is unreliable.
const LEFT_OUT: f32 = 0.1;

/// Consistency of measurements and model, averaged over the last seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Monitor {
    nis: Share,
    left_out: Share,
    seen: u8,
}

impl Monitor {
    /// A monitor without samples.
    pub(crate) const NEW: Self = Self { nis: Share::NONE, left_out: Share::NONE, seen: 0 };

    /// Adds a sample: the number of its measurements, the number rejected, and the normalised innovations squared,
    /// where variances are known.
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

    /// The present assessment.
    pub(crate) fn health(&self) -> Health {
        Health::GOOD
            .with(Reason::Rejected, self.left_out.exceeds(LEFT_OUT))
            .with(Reason::Innovations, self.seen >= NIS_FIRST && self.nis.exceeds(NIS))
    }
}

/// An exponentially decaying sum and the number of its terms.
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
