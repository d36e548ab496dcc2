/// Converts the times of the streams, in seconds, to the nanoseconds of the file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Clock {
    zero_s: f64,
}

/// The largest number of seconds that fits into the timestamp of a message, which reaches to the year 2106.
const SECONDS: f64 = u32::MAX as f64;

impl Clock {
    /// Returns a clock that can represent all `times` (s), shifted by whole seconds if necessary.
    ///
    /// # Errors
    /// A sentence that describes what is wrong with the times.
    pub(super) fn holding(times: impl Iterator<Item = f64>) -> Result<Self, String> {
        let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
        for time in times {
            if !time.is_finite() {
                return Err(format!("a time of {time} s cannot be written"));
            }
            (first, last) = (first.min(time), last.max(time));
        }
        if first >= 0.0 && last < SECONDS || first > last {
            return Ok(Self { zero_s: 0.0 });
        }
        let zero_s = first.floor();
        if last - zero_s < SECONDS {
            Ok(Self { zero_s })
        } else {
            Err(format!("times from {first} s to {last} s are too far apart to be written"))
        }
    }

    /// The stream time, in seconds, that is 0 in the file.
    pub(super) const fn zero_s(self) -> f64 {
        self.zero_s
    }

    /// Converts a stream time (s) to a file time (ns).
    pub(super) fn nanoseconds(self, time: f64) -> u64 {
        let since = time - self.zero_s;
        // Whole seconds are converted separately: a day in nanoseconds already takes 47 of the 53 bits.
        let whole = since.floor();
        whole as u64 * 1_000_000_000 + ((since - whole) * 1e9).round() as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_that_fit_stay_and_others_are_moved_by_whole_seconds() -> Result<(), String> {
        let utc = Clock::holding([1_763_700_000.25, 0.0].into_iter())?;
        assert_eq!(
            (utc.zero_s(), utc.nanoseconds(1_763_700_000.25)),
            (0.0, 1_763_700_000_250_000_000)
        );
        let early = Clock::holding([2.0, -1.75].into_iter())?;
        assert_eq!((early.zero_s(), early.nanoseconds(-1.75)), (-2.0, 250_000_000));
        let late = Clock::holding([9e12, 9e12 + 1.0].into_iter())?;
        assert_eq!(late.nanoseconds(9e12 + 1.0), 1_000_000_000);
        assert_eq!(Clock::holding(std::iter::empty())?.zero_s(), 0.0);
        Ok(())
    }

    #[test]
    fn times_without_a_place_on_any_clock_are_refused() {
        for times in [[0.0, f64::NAN], [f64::INFINITY, 0.0], [-1e10, 1e10]] {
            assert!(Clock::holding(times.into_iter()).is_err(), "{times:?}");
        }
    }
}
