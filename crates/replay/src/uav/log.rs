//! Logs of flights.

use super::Error;

/// The relative deviation from the usual interval that counts as jitter: autopilots log when they have time.
const JITTER: f64 = 0.4;
/// The share of intervals that must be regular: the usual one, or where samples were lost, a multiple of it up to
/// `MOST_LOST`, to within `NEAR` of one interval.
const REGULAR: f64 = 0.75;
const MOST_LOST: f64 = 10.0;
const NEAR: f64 = 0.15;
/// The length, in usual intervals, above which an interval is a gap: samples are missing.
const GAP: f64 = 1.5;

/// A line of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Time, µs.
    pub t_us: i64,
    /// The inputs δe, δt.
    pub input: [f64; 2],
    /// The measurements in the order of the log's outputs; `None` for an empty field.
    pub measured: Vec<Option<f64>>,
}

/// The log of a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    /// The indices of the model's outputs that the log has.
    pub outputs: Vec<usize>,
    /// The samples, in the order of their times.
    pub samples: Vec<Sample>,
    /// The usual time between samples, s.
    pub interval_s: f64,
    /// The number of gaps, where samples are missing.
    pub gaps: usize,
}

impl Log {
    /// A log of samples, in the order of their times, of some of a model's outputs.
    ///
    /// # Errors
    /// [`Error::NotLater`], [`Error::TooShort`] or [`Error::Irregular`] for times at which no filter can be built.
    pub fn new(outputs: Vec<usize>, samples: Vec<Sample>) -> Result<Self, Error> {
        let step = |pair: &[Sample]| pair[1].t_us.saturating_sub(pair[0].t_us) as f64 / 1e6;
        let mut steps: Vec<f64> = samples.windows(2).map(step).collect();
        if let Some(before) = steps.iter().position(|step| *step <= 0.0) {
            return Err(Error::NotLater { index: before + 1 });
        }
        steps.sort_by(f64::total_cmp);
        let usual = *steps.get(steps.len() / 2).ok_or(Error::TooShort)?;
        let is_near = |step: &&f64| {
            let times = *step / usual;
            let off = (times - times.round()).abs();
            (times - 1.0).abs() <= JITTER
                || (off <= NEAR && (2.0..=MOST_LOST).contains(&times.round()))
        };
        let near = steps.iter().filter(is_near).count();
        let of = steps.len();
        if (near as f64) < REGULAR * of as f64 {
            return Err(Error::Irregular { near, of, usual });
        }
        let gaps = steps.iter().filter(|step| **step > GAP * usual).count();
        Ok(Self { outputs, samples, interval_s: usual, gaps })
    }
}

/// True states: the time in µs, and those of α, q, V, θ that the file has.
pub type Truth = Vec<(i64, [Option<f64>; 4])>;

#[cfg(test)]
mod tests {
    use super::*;

    /// A log whose intervals are these multiples of 20 ms, in turn.
    fn log(parts: [f64; 3]) -> Result<Log, Error> {
        let mut t_us = 0;
        let samples = (0..300).map(|k| {
            t_us += (20_000.0 * parts[k % 3]) as i64;
            Sample { t_us, input: [0.0; 2], measured: vec![Some(0.0)] }
        });
        Log::new(vec![0], samples.collect())
    }

    #[test]
    fn times_that_jitter_are_read_and_times_without_an_interval_are_not() {
        for parts in [[1.0; 3], [0.7, 1.0, 1.3]] {
            let log = log(parts).unwrap();
            assert!((log.interval_s - 0.02).abs() < 1e-9 && log.gaps == 0, "{log:?}");
        }
        assert!(matches!(log([0.4, 1.0, 1.6]), Err(Error::Irregular { .. })));
        // Every third or fourth sample was lost.
        let lost = log([1.0, 1.0, 2.0]).unwrap();
        assert!((lost.interval_s - 0.02).abs() < 1e-9 && lost.gaps == 100, "{lost:?}");
    }
}
