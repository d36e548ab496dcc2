use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// Distinguishes standing from moving by the energy of an accelerometer's changes.
///
/// The acceleration's deviation from its own mean over the last half second is squared and averaged over the last 0.15
/// s. Constants such as gravity or a bias do not matter. A robot's wheels shake it by half a metre per second squared
/// even at a snail's pace; while it stands, only the sensor's noise remains.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Stillness<T: Scalar> {
    last_us: Option<u64>,
    mean: SVector<T, 3>,
    variance: T,
    calm: bool,
    /// Time of the last jolt (µs), if any.
    jolted_us: Option<u64>,
}

impl<T: Scalar> Stillness<T> {
    /// Root mean square of the changes below which the tag counts as standing, m/s².
    const LIMIT: f64 = 0.3;
    /// Time constant of the mean, s.
    const MEAN_TIME: f64 = 0.5;
    /// Time constant of the mean square, s.
    const SQUARE_TIME: f64 = 0.15;
    /// Root mean square of the changes during a footstep, m/s².
    const JOLT: f64 = 1.0;
    /// Time after a jolt during which the tag does not count as standing, µs: longer than a footstep.
    const STEP_US: u64 = 700_000;
    /// Longest gap between samples after which stillness is still known, µs.
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

    /// Processes an accelerometer sample, with the magnitude of the push if it is known: a steady push looks like
    /// gravity, but is not rest.
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
        // Above a few metres per second squared it moves, however much: the square stays in range.
        let size = T::norm(deviation.as_array()).min(T::TWO);
        self.variance += (size * size - self.variance) * share(T::from_f64(Self::SQUARE_TIME));
        let calm = self.variance < T::from_f64(Self::LIMIT * Self::LIMIT);
        self.calm = calm && push < T::from_f64(Self::LIMIT);
        if self.variance > T::from_f64(Self::JOLT * Self::JOLT) {
            self.jolted_us = Some(time_us);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tag whose accelerometer is sampled a hundred times per second.
    struct Ride {
        stillness: Stillness<f64>,
        time_us: u64,
    }

    impl Ride {
        /// A tag that has stood for two seconds.
        fn at_rest() -> Self {
            let ride = Self { stillness: Stillness::new(), time_us: 0 };
            ride.on(200, 0.0, 0.0)
        }

        /// Continues for this many samples, with an alternating shake and a push of these sizes (m/s²).
        fn on(mut self, samples: u64, shake: f64, push: f64) -> Self {
            for sample in 0..samples {
                self.time_us += 10_000;
                let shake = if sample % 2 == 0 { shake } else { -shake };
                let acceleration = SVector::from([0.1, shake, 9.8]);
                self.stillness.update(self.time_us, &acceleration, push);
            }
            self
        }

        /// Whether it counts as standing at this time after the last sample (µs).
        fn stands_after(&self, later_us: u64) -> bool {
            self.stillness.is_still(self.time_us + later_us)
        }
    }

    #[test]
    fn a_tag_stands_that_is_shaken_by_less_than_a_third_of_a_metre_per_second_squared() {
        assert!(!Stillness::<f64>::new().is_still(0));
        assert!(Ride::at_rest().stands_after(0));
        assert!(Ride::at_rest().on(200, 0.28, 0.0).stands_after(0));
        assert!(!Ride::at_rest().on(200, 0.32, 0.0).stands_after(0));
    }

    #[test]
    fn rest_has_to_be_seen_for_a_third_of_a_second() {
        let begun = |samples| {
            Ride { stillness: Stillness::new(), time_us: 0 }.on(samples, 0.0, 0.0).stands_after(0)
        };
        assert!(!begun(30) && begun(45));
    }

    #[test]
    fn a_steady_push_is_no_rest() {
        assert!(Ride::at_rest().on(100, 0.0, 0.29).stands_after(0));
        assert!(!Ride::at_rest().on(100, 0.0, 0.31).stands_after(0));
    }

    #[test]
    fn stillness_is_known_for_half_a_second() {
        let ride = Ride::at_rest();
        assert!(ride.stands_after(500_000) && !ride.stands_after(500_001));
        let after = |gap_us| Ride { time_us: ride.time_us + gap_us, ..Ride::at_rest() };
        assert!(after(490_000).on(1, 0.0, 0.0).stands_after(0));
        assert!(!after(490_001).on(1, 0.0, 0.0).stands_after(0), "it begins anew");
    }

    #[test]
    fn after_a_jolt_a_tag_does_not_stand_for_the_time_of_a_step() {
        // Shaken by less, it counts as standing as soon as the squares are forgotten.
        assert!(Ride::at_rest().on(100, 0.9, 0.0).on(45, 0.0, 0.0).stands_after(0));
        let jolted = || Ride::at_rest().on(100, 1.2, 0.0);
        assert!(!jolted().on(70, 0.0, 0.0).stands_after(0));
        assert!(jolted().on(85, 0.0, 0.0).stands_after(0));
    }

    #[test]
    fn one_wild_sample_is_no_jolt_however_wild() {
        let knocked = |shake| Ride::at_rest().on(1, shake, 0.0).on(90, 0.0, 0.0);
        assert!(!Ride::at_rest().on(1, 15.0, 0.0).stands_after(0));
        assert!(knocked(15.0).stands_after(0));
    }

    #[test]
    fn what_is_constant_is_forgotten_in_three_seconds() {
        let mut ride = Ride::at_rest();
        for (samples, stands) in [(20, false), (280, true)] {
            for _ in 0..samples {
                ride.time_us += 10_000;
                // It was turned on its side.
                ride.stillness.update(ride.time_us, &SVector::from([9.8, 0.0, 0.0]), 0.0);
            }
            assert_eq!(ride.stands_after(0), stands, "after {samples} samples");
        }
    }

    #[test]
    fn few_samples_show_rest_as_well() {
        let mut stillness = Stillness::new();
        for sample in 1..=10 {
            stillness.update(300_000 * sample, &SVector::from([0.1, 0.0, 9.8]), 0.0);
        }
        assert!(stillness.is_still(3_000_000));
    }
}
