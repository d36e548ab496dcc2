//! Averaging of a log down to a lower rate: no sample is dropped.
//!
//! Time is divided into blocks of one period of the lower rate, counted from half a log period before the first sample
//! so that jitter moves no sample across an edge. All samples of a block become one: the mean of their values at the
//! mean of their times. A signal that grows linearly is therefore neither delayed nor advanced, whatever a timestamp
//! means in the log. A block without samples, a gap, stays a gap. The truth is interpolated at the block's time.

use kestirim_replay::pedestrian::{TrackPoint, position_at};

use super::log::Log;
use crate::Error;
use crate::systems::pedestrian::Sample;

/// The factor by which a rate may exceed the log's own before it is refused: clocks are inexact.
const RATE_TOLERANCE: f64 = 1.05;

/// Averages a log down to `rate_hz`.
///
/// # Errors
/// [`Error::Usage`] if the log's rate is lower, or `rate_hz` is not a positive number.
pub fn average_down(log: &Log, rate_hz: f64) -> Result<Log, Error> {
    if !(rate_hz.is_finite() && rate_hz > 0.0) {
        return Err(Error::Usage(format!("--rate expects a positive number, found {rate_hz}")));
    }
    let Some(period_us) = median_period_us(&log.samples) else { return Ok(log.clone()) };
    if rate_hz * period_us > 1e6 * RATE_TOLERANCE {
        return Err(Error::Usage(format!(
            "--rate {rate_hz} Hz is faster than the log's {:.1} Hz; it only averages down",
            1e6 / period_us
        )));
    }
    let start_us = log.start_us() as f64 - period_us / 2.0;
    let block = |sample: &Sample| ((sample.time_us as f64 - start_us) * rate_hz * 1e-6) as u64;
    let blocks = log.samples.chunk_by(|a, b| block(a) == block(b));
    let samples: Vec<_> = blocks.map(average).collect();
    let truth = log.truth.as_ref().map(|truth| at_times_of(&samples, truth));
    let field = log.field.as_ref().map(|field| average_field(log, field, block));
    let (import, warnings) = (log.import.clone(), log.warnings.clone());
    Ok(Log { samples, truth, field, import, warnings })
}

/// The rate of a log (Hz); `None` for fewer than two samples.
pub fn rate_hz(samples: &[Sample]) -> Option<f64> {
    median_period_us(samples).map(|period_us| 1e6 / period_us)
}

/// The median time between samples (µs); `None` for fewer than two. Repeated times count once.
fn median_period_us(samples: &[Sample]) -> Option<f64> {
    let steps = samples.windows(2).map(|pair| (pair[1].time_us - pair[0].time_us) as f64);
    let steps: Vec<_> = steps.filter(|&step| step > 0.0).collect();
    (!steps.is_empty()).then(|| crate::metrics::median(&steps))
}

fn average(block: &[Sample]) -> Sample {
    let count = block.len() as f64;
    let mean = |vector: fn(&Sample) -> [f64; 3]| {
        std::array::from_fn(|i| block.iter().map(|sample| vector(sample)[i]).sum::<f64>() / count)
    };
    let start_us = block[0].time_us;
    let offsets_us: f64 = block.iter().map(|sample| (sample.time_us - start_us) as f64).sum();
    Sample {
        time_us: start_us + (offsets_us / count).round() as u64,
        specific_force: mean(|sample| sample.specific_force),
        angular_rate: mean(|sample| sample.angular_rate),
    }
}

/// The mean of the field in each block, over the samples that have one.
fn average_field(log: &Log, field: &[[f64; 3]], block: impl Fn(&Sample) -> u64) -> Vec<[f64; 3]> {
    let pairs: Vec<_> = log.samples.iter().zip(field).collect();
    let blocks = pairs.chunk_by(|(a, _), (b, _)| block(a) == block(b));
    let mean = |part: &[(&Sample, &[f64; 3])]| {
        let known = part.iter().filter(|(_, field)| field.iter().all(|axis| axis.is_finite()));
        let known: Vec<_> = known.collect();
        std::array::from_fn(|i| {
            known.iter().map(|(_, field)| field[i]).sum::<f64>() / known.len() as f64
        })
    };
    blocks.map(mean).collect()
}

fn at_times_of(samples: &[Sample], truth: &[TrackPoint]) -> Vec<TrackPoint> {
    let times = samples.iter().map(|sample| sample.time_us);
    times
        .filter_map(|time_us| {
            position_at(truth, time_us).map(|position| TrackPoint { time_us, position })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A log in which every value grows by one per second.
    fn ramp(times_us: impl IntoIterator<Item = u64>) -> Log {
        let seconds = |time_us: u64| [time_us as f64 * 1e-6; 3];
        let sample = |time_us| Sample {
            time_us,
            specific_force: seconds(time_us),
            angular_rate: seconds(time_us),
        };
        let samples: Vec<_> = times_us.into_iter().map(sample).collect();
        let point = |s: &Sample| TrackPoint { time_us: s.time_us, position: s.specific_force };
        let truth = Some(samples.iter().map(point).collect());
        Log { samples, truth, ..Log::default() }
    }

    #[test]
    fn nothing_is_shifted_and_nothing_dropped() {
        let jitter = |i: u64| 1_000_000 + 5_000 * i + [0, 3, 1][i as usize % 3];
        for rate in [200.0, 150.0, 100.0, 80.0, 50.0, 7.0] {
            let slow = average_down(&ramp((0..1_001).map(jitter)), rate).unwrap();
            assert_eq!(slow.samples.len(), (5.005 * rate).ceil() as usize, "{rate} Hz");
            for (sample, truth) in slow.samples.iter().zip(slow.truth.unwrap()) {
                let seconds = sample.time_us as f64 * 1e-6;
                assert!((sample.specific_force[0] - seconds).abs() < 1e-6);
                assert!((sample.angular_rate[2] - seconds).abs() < 1e-6);
                assert!((truth.position[1] - seconds).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn whole_ratios_make_whole_blocks() {
        let slow = average_down(&ramp((0..8).map(|i| i * 5_000)), 50.0).unwrap();
        assert_eq!(slow.samples.iter().map(|s| s.time_us).collect::<Vec<_>>(), [7_500, 27_500]);
    }

    #[test]
    fn gaps_stay_and_repeated_samples_count() {
        let slow = average_down(&ramp([0, 0, 10_000, 500_000, 510_000]), 50.0).unwrap();
        let times: Vec<_> = slow.samples.iter().map(|sample| sample.time_us).collect();
        assert_eq!(times, [3_333, 505_000]);
    }

    #[test]
    fn faster_is_refused() {
        let log = ramp((0..100).map(|i| i * 10_000));
        assert!(average_down(&log, 104.0).is_ok());
        assert!(average_down(&log, 106.0).unwrap_err().to_string().contains("the log's 100.0 Hz"));
        for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(average_down(&log, rate).is_err());
        }
        assert_eq!(average_down(&ramp([5]), 50.0).unwrap(), ramp([5]));
    }
}
