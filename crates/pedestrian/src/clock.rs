use crate::Error;
use kestirim_scalar::Scalar;

/// The meaning of a new sample's time stamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Tick<T> {
    /// The first sample: nothing to integrate yet.
    First,
    /// The same time again, as the recorder wrote a row twice; or the same rates, as the sensor was not read again.
    Duplicate,
    /// The step to integrate (s), and the duration of missing samples, if there are any (s).
    Elapsed { interval: T, missing: Option<T> },
}

/// Real time steps from time stamps.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Clock {
    last_us: Option<u64>,
    /// The last step that was no gap (µs); zero before the first.
    step_us: u32,
}

impl Clock {
    /// A longer step than this means missing samples (µs): no slower stream shows how a foot turns.
    const GAP_US: u64 = 60_000;
    /// A longer step than this (µs) means missing samples if it is also more than `LONGER` times the step before: in 40
    /// ms a foot in swing may turn by 0.4 rad.
    const SHORT_GAP_US: u64 = 40_000;
    /// The ratio to the step before from which on a step above `SHORT_GAP_US` is a gap.
    const LONGER: u64 = 3;
    /// The longest step that is integrated (µs): in a longer gap the motion of the foot is unknown.
    const LONGEST_US: u64 = 200_000;
    /// The longest duration of a gap (µs): after a minute anything may have happened.
    const MINUTE_US: u64 = 60_000_000;

    /// Interprets the time `time_us`, without advancing to it.
    pub(crate) fn tick<T: Scalar>(&self, time_us: u64) -> Result<Tick<T>, Error> {
        let Some(last_us) = self.last_us else { return Ok(Tick::First) };
        let elapsed = time_us.checked_sub(last_us).ok_or(Error::TimeBackwards)?;
        if elapsed == 0 {
            return Ok(Tick::Duplicate);
        }
        let interval = T::from_micro(elapsed.min(Self::LONGEST_US) as i32);
        let missing = if elapsed > Self::SHORT_GAP_US { self.missing(elapsed) } else { None };
        Ok(Tick::Elapsed { interval, missing })
    }

    /// The duration of missing samples in a step of this length (µs), if there are any (s).
    #[cold]
    #[inline(never)]
    fn missing<T: Scalar>(&self, elapsed: u64) -> Option<T> {
        let is_longer = self.step_us != 0 && elapsed > Self::LONGER * u64::from(self.step_us);
        let is_gap = elapsed > Self::GAP_US || is_longer;
        is_gap.then(|| T::from_micro(elapsed.min(Self::MINUTE_US) as i32))
    }

    /// Advances to a time.
    pub(crate) fn set(&mut self, time_us: u64) {
        let last_us = self.last_us.replace(time_us).unwrap_or(time_us);
        // More than an hour may leave any remainder; then one short gap may go unreported.
        let step_us = (time_us as u32).wrapping_sub(last_us as u32);
        if (1..=Self::GAP_US as u32).contains(&step_us) {
            self.step_us = step_us;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_what_has_elapsed_and_at_most_a_fifth_of_a_second() {
        let mut clock = Clock::default();
        assert_eq!(clock.tick::<f64>(5_000_000), Ok(Tick::First));
        clock.set(4_980_000);
        clock.set(5_000_000);
        let tick = |elapsed_us: u64| clock.tick::<f64>(5_000_000 + elapsed_us);
        assert_eq!(tick(0), Ok(Tick::Duplicate));
        for (elapsed_us, interval, missing) in [
            (1, 1e-6, None),
            (60_000, 0.06, None),
            (60_001, 0.060_001, Some(0.060_001)),
            (250_000, 0.2, Some(0.25)),
            (1_000_000_000, 0.2, Some(60.0)),
        ] {
            let Ok(Tick::Elapsed { interval: found, missing: gap }) = tick(elapsed_us) else {
                panic!("{elapsed_us} µs are a step");
            };
            assert!((found - interval).abs() < 1e-9 && gap.is_some() == missing.is_some());
            let difference = gap.unwrap_or_default() - missing.unwrap_or_default();
            assert!(difference.abs() < 1e-9, "{elapsed_us}: {gap:?}");
        }
        assert_eq!(clock.tick::<f64>(4_999_999), Err(Error::TimeBackwards));
    }

    #[test]
    fn of_a_fast_stream_a_shorter_step_is_a_gap() {
        // The preceding step, if there is one, the step (µs), and whether it is a gap.
        for (before_us, elapsed_us, is_gap) in [
            (5_000, 40_000, false),
            (5_000, 40_001, true),
            (14_000, 42_000, false),
            (14_000, 42_001, true),
            (0, 60_000, false),
            (0, 60_001, true),
        ] {
            let mut clock = Clock::default();
            clock.set(0);
            clock.set(before_us);
            // A row that was written twice is no step.
            clock.set(before_us);
            let Ok(Tick::Elapsed { missing, .. }) = clock.tick::<f64>(before_us + elapsed_us)
            else {
                panic!("{elapsed_us} µs are a step");
            };
            assert_eq!(missing.is_some(), is_gap, "{elapsed_us} after {before_us}");
        }
        // A gap is no step with which another is compared.
        let mut clock = Clock::default();
        for time_us in [0, 5_000, 905_000] {
            clock.set(time_us);
        }
        assert!(matches!(clock.tick::<f64>(950_000), Ok(Tick::Elapsed { missing: Some(_), .. })));
    }
}
