use crate::Error;
use kestirim_scalar::Scalar;

/// Meaning of the time stamp of a new sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Tick<T> {
    /// The first sample: nothing to integrate yet.
    First,
    /// The same time again: the recorder wrote a row twice.
    Duplicate,
    /// Seconds since the sample before, and whether samples are missing between.
    Elapsed { interval: T, gap: bool },
}

/// Real time steps from time stamps.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Clock {
    last_us: Option<u64>,
}

impl Clock {
    /// Steps beyond this are missing samples (µs): a tenth of a second spans half a swing.
    const GAP_US: u64 = 100_000;
    /// Longest step that is integrated (µs): the motion of the foot in a longer gap is not known.
    const LONGEST_US: u64 = 200_000;

    /// The step to `time_us`, without taking it.
    pub(crate) fn tick<T: Scalar>(&self, time_us: u64) -> Result<Tick<T>, Error> {
        let Some(last_us) = self.last_us else { return Ok(Tick::First) };
        let elapsed = time_us.checked_sub(last_us).ok_or(Error::TimeBackwards)?;
        if elapsed == 0 {
            return Ok(Tick::Duplicate);
        }
        let interval = T::from_micro(elapsed.min(Self::LONGEST_US) as i32);
        Ok(Tick::Elapsed { interval, gap: elapsed > Self::GAP_US })
    }

    /// Takes the step.
    pub(crate) fn set(&mut self, time_us: u64) {
        self.last_us = Some(time_us);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_what_has_elapsed_and_at_most_a_fifth_of_a_second() {
        let mut clock = Clock::default();
        assert_eq!(clock.tick::<f64>(5_000_000), Ok(Tick::First));
        clock.set(5_000_000);
        let tick = |elapsed_us: u64| clock.tick::<f64>(5_000_000 + elapsed_us);
        assert_eq!(tick(0), Ok(Tick::Duplicate));
        for (elapsed_us, interval, gap) in [
            (1, 1e-6, false),
            (100_000, 0.1, false),
            (100_001, 0.100_001, true),
            (200_001, 0.2, true),
        ] {
            let Ok(Tick::Elapsed { interval: found, gap: is_gap }) = tick(elapsed_us) else {
                panic!("{elapsed_us} µs are a step");
            };
            assert!((found - interval).abs() < 1e-9 && is_gap == gap, "{elapsed_us}: {found}");
        }
        assert_eq!(clock.tick::<f64>(4_999_999), Err(Error::TimeBackwards));
    }
}
