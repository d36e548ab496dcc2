//! Detection of senders that are restarted, and of implausible times.

/// The longest delay of a datagram that others have overtaken, in microseconds.
const LATE_US: u64 = 1_000_000;
/// The longest plausible gap between two measurements, in microseconds: an hour.
const AHEAD_US: u64 = 3_600_000_000;
/// The number of consecutive times that are too late after which the sender's clock counts as restarted.
const ANEW: u32 = 50;
/// The number of consecutive times that are far ahead after which they are accepted.
const MEANT: u32 = 5;

/// Tracks the clock of a sender.
#[derive(Debug, Default)]
pub(super) struct Clock {
    latest_us: Option<u64>,
    /// The number of consecutive times that were too late.
    late: u32,
    /// The number of consecutive times that were far ahead.
    ahead: u32,
}

/// The verdict on a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    /// The time is plausible and left to the estimator.
    Fits,
    /// The time is implausible.
    Odd,
    /// The sender has restarted.
    Anew,
}

impl Clock {
    /// Judges the time of the next measurement.
    pub(super) fn judge(&mut self, time_us: u64) -> Verdict {
        let Some(latest_us) = self.latest_us else { return self.accept(time_us, Verdict::Fits) };
        if time_us.saturating_add(LATE_US) < latest_us {
            (self.late, self.ahead) = (self.late + 1, 0);
            return if self.late < ANEW {
                Verdict::Odd
            } else {
                self.accept(time_us, Verdict::Anew)
            };
        }
        if time_us > latest_us.saturating_add(AHEAD_US) {
            (self.late, self.ahead) = (0, self.ahead + 1);
            return if self.ahead < MEANT {
                Verdict::Odd
            } else {
                self.accept(time_us, Verdict::Fits)
            };
        }
        self.accept(time_us.max(latest_us), Verdict::Fits)
    }

    fn accept(&mut self, latest_us: u64, verdict: Verdict) -> Verdict {
        *self = Self { latest_us: Some(latest_us), ..Self::default() };
        verdict
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_wrong_time_changes_nothing() {
        let mut clock = Clock::default();
        for step in 0..1000_u64 {
            let time_us = step * 10_000 + 100_000_000;
            assert_eq!(clock.judge(time_us), Verdict::Fits);
            if step % 10 == 0 {
                assert_eq!(clock.judge(u64::MAX - step), Verdict::Odd);
                assert_eq!(clock.judge(step), Verdict::Odd);
            }
            // A datagram that was overtaken in transit is not wrong.
            assert_eq!(clock.judge(time_us.saturating_sub(500_000)), Verdict::Fits);
        }
    }

    #[test]
    fn a_sender_may_begin_anew_and_pause_for_long() {
        let mut clock = Clock::default();
        assert_eq!(clock.judge(90_000_000_000), Verdict::Fits);
        let verdicts: Vec<_> = (0..60).map(|step| clock.judge(step * 10_000)).collect();
        assert_eq!(verdicts.iter().position(|verdict| *verdict == Verdict::Anew), Some(49));
        assert!(verdicts[50..].iter().all(|verdict| *verdict == Verdict::Fits));
        let verdicts = [0; 6].map(|_| clock.judge(90_000_000_000));
        assert_eq!(verdicts.iter().position(|verdict| *verdict == Verdict::Fits), Some(4));
    }
}
