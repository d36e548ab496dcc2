use crate::Error;
use kestirim_scalar::Scalar;

/// Meaning of the time stamp of a new sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Tick<T> {
    /// The first sample: nothing to integrate yet.
    First,
    /// The same time again: the recorder wrote a row twice.
    Duplicate,
    /// Seconds since the sample before.
    Elapsed {
        interval: T,
        /// Samples are missing between.
        gap: bool,
        /// So many that the motion in between is not known.
        lost: bool,
    },
}

/// Real time steps from time stamps.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Clock {
    last_us: Option<u64>,
    /// The time stamp that was refused last, until one is taken.
    refused_us: Option<u64>,
}

impl Clock {
    /// Steps beyond this are missing samples (µs): a tenth of a second spans half a swing.
    const GAP_US: u64 = 100_000;
    /// Longest step that is integrated (µs): the motion of the foot in a longer gap is not known.
    const LONGEST_US: u64 = 200_000;
    /// Samples that come late are not this old (µs): the clock was set back, if a second one agrees.
    const SET_BACK_US: u64 = 1_000_000;

    /// The step to `time_us`, without taking it.
    #[inline]
    pub(crate) fn tick<T: Scalar>(&self, time_us: u64) -> Result<Tick<T>, Error> {
        let Some(last_us) = self.last_us else { return Ok(Tick::First) };
        let Some(elapsed) = time_us.checked_sub(last_us) else {
            return if self.is_set_back(last_us, time_us) {
                Ok(Self::step(Self::LONGEST_US.saturating_add(1)))
            } else {
                Err(Error::TimeBackwards)
            };
        };
        if elapsed == 0 {
            return Ok(Tick::Duplicate);
        }
        Ok(Self::step(elapsed))
    }

    #[inline]
    fn step<T: Scalar>(elapsed: u64) -> Tick<T> {
        Tick::Elapsed {
            interval: T::from_micro(elapsed.min(Self::LONGEST_US) as i32),
            gap: elapsed > Self::GAP_US,
            lost: elapsed > Self::LONGEST_US,
        }
    }

    /// Whether a time before the last is that of a clock set back: much older, and shortly after one that was
    /// refused for the same reason. Otherwise one wrong time stamp far ahead would be the last one taken.
    #[cold]
    fn is_set_back(&self, last_us: u64, time_us: u64) -> bool {
        last_us.saturating_sub(time_us) > Self::SET_BACK_US
            && self.refused_us.is_some_and(|refused_us| {
                time_us
                    .checked_sub(refused_us)
                    .is_some_and(|later| (1..Self::SET_BACK_US).contains(&later))
            })
    }

    /// Notes a time stamp that was refused.
    #[cold]
    pub(crate) fn refuse(&mut self, time_us: u64) {
        self.refused_us = Some(time_us);
    }

    /// Whether a time is so long after the last one taken that the motion since is not known.
    pub(crate) fn is_lost(&self, time_us: u64) -> bool {
        self.last_us.is_some_and(|last_us| time_us.abs_diff(last_us) > Self::LONGEST_US)
    }

    /// Takes the step.
    #[inline]
    pub(crate) fn set(&mut self, time_us: u64) {
        self.last_us = Some(time_us);
        self.refused_us = None;
    }
}
