//! Checks of the log of a flight before an estimator follows it.

use kestirim_health::Reason;

use super::{Log, Model, STATE_COLUMNS, Sample};
use crate::Finding;
use crate::metrics::median;

/// The size of a spike, in usual changes: a measurement that jumps by more than this and back is one.
const SPIKE: f64 = 30.0;
/// The share of spikes above which they are reported as a fault.
const MANY: f64 = 0.002;
/// The number of samples before and after a jump that decide whether it is a step of the sensor. A step is large, the
/// medians before and after it differ by at least the share `STAYS` of it, and nothing else there jumps half as far.
const AROUND: usize = 10;
const STAYS: f64 = 0.7;
/// Outputs that may step: accelerations do, with thrust and elevator.
const ACCELERATIONS: [&str; 3] = ["ax", "ay", "az"];
/// The pitch rate, which may step at low sample rates while an input changes by more than the share `STEERED` of its
/// whole range.
const RATE: &str = "q";
const STEERED: f64 = 0.05;
/// The number of samples in a row that stay the same to the last digit while others change, from which on a sensor is
/// stuck.
const STUCK: usize = 50;

/// The findings about a log. Outputs have the names of the model, or without one those of the states.
pub fn check(log: &Log, model: Option<&Model>) -> Vec<Finding> {
    let count = log.samples.len();
    let mut findings = vec![Finding::note(
        "rate",
        format!("{count} samples at {:.1} Hz, {} gaps", 1.0 / log.interval_s, log.gaps),
    )];
    let name = |output: usize| match model {
        Some(model) => model.outputs.get(output).map_or("", |(name, _)| name),
        None => STATE_COLUMNS.get(output).copied().unwrap_or_default(),
    };
    let columns: Vec<Vec<f64>> = (0..log.outputs.len())
        .map(|column| log.samples.iter().filter_map(|sample| measured(sample, column)).collect())
        .collect();
    let steers = log.samples.windows(2).any(|pair| pair[0].input != pair[1].input);
    let flies = steers || columns.iter().any(|values| varies(values));
    for (column, (values, &output)) in columns.iter().zip(&log.outputs).enumerate() {
        let name = name(output);
        let missing = count - values.len();
        if missing > 0 {
            let share = 100.0 * missing as f64 / count as f64;
            findings.push(Finding::note("missing", format!("{name}: {share:.1} % of the samples")));
        }
        let limit = SPIKE * usual_change(values);
        findings.extend(spikes(name, values, limit));
        findings.extend(step(name, log, column, limit));
        findings.extend(stuck(name, values).filter(|_| flies));
    }
    findings
}

fn measured(sample: &Sample, column: usize) -> Option<f64> {
    sample.measured.get(column).copied().flatten()
}

fn spikes(name: &str, values: &[f64], limit: f64) -> Option<Finding> {
    let is_spike = |three: &&[f64]| {
        let (there, back) = (three[1] - three[0], three[2] - three[1]);
        there * back < 0.0 && there.abs().min(back.abs()) > limit
    };
    let count = values.windows(3).filter(is_spike).count();
    (limit > 0.0 && count as f64 > MANY * values.len() as f64).then(|| {
        Finding::fault(
            "spikes",
            Reason::Rejected,
            format!("{name} jumps away and back {count} times in {} samples", values.len()),
            "the estimators leave them out, and know less meanwhile",
            "look at the sensor's wiring and at the logger",
        )
    })
}

/// The median of the changes that are not zero: if a sensor is stuck for half of the flight, the median of all changes
/// would be zero, and any change in the other half a spike.
fn usual_change(values: &[f64]) -> f64 {
    let changes = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    median(&changes.filter(|change| *change > 0.0).collect::<Vec<_>>())
}

/// A finding if an output jumps from one sample to the next and stays there.
fn step(name: &str, log: &Log, column: usize, limit: f64) -> Option<Finding> {
    if ACCELERATIONS.contains(&name) {
        return None;
    }
    let usual_us = 1.5e6 * log.interval_s;
    let all = spans(&log.samples);
    let is_steered = |around: &[Sample]| {
        spans(around).iter().zip(all).any(|(&there, all)| all > 0.0 && there > STEERED * all)
    };
    let found = log.samples.windows(2 * AROUND).find_map(|around| {
        let by = measured(&around[AROUND], column)? - measured(&around[AROUND - 1], column)?;
        if limit <= 0.0 || by.abs() <= limit {
            return None;
        }
        let follow =
            |pair: &[Sample]| (pair[1].t_us.saturating_sub(pair[0].t_us) as f64) < usual_us;
        let values: Vec<f64> =
            around.iter().filter_map(|sample| measured(sample, column)).collect();
        if values.len() < around.len() || !around.windows(2).all(follow) {
            return None;
        }
        let (before, after) = values.split_at(AROUND);
        let others = [before, after].into_iter().flat_map(|part| part.windows(2));
        let most = others.map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        let stays = (median(after) - median(before)) / by >= STAYS;
        let stands_out = by.abs() > 2.0 * most && stays && !(name == RATE && is_steered(around));
        stands_out.then_some((around[AROUND].t_us, by))
    });
    found.map(|(t_us, by)| {
        Finding::fault(
            "steps",
            Reason::Innovations,
            format!("{name} steps by {by:.3} at {:.2} s and stays there", t_us as f64 * 1e-6),
            "no aircraft does: before or after it the sensor is off by as much",
            "look at the sensor, or leave its fields empty where it is wrong",
        )
    })
}

/// The range of each input in these samples.
fn spans(samples: &[Sample]) -> [f64; 2] {
    std::array::from_fn(|input| {
        let values = samples.iter().map(|sample| sample.input[input]);
        let [least, most] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], it| {
            [least.min(it), most.max(it)]
        });
        most - least
    })
}

fn varies(values: &[f64]) -> bool {
    values.windows(2).any(|pair| pair[0] != pair[1])
}

fn stuck(name: &str, values: &[f64]) -> Option<Finding> {
    let longest = values.chunk_by(|a, b| a == b).map(<[f64]>::len).max().unwrap_or(0);
    (longest >= STUCK).then(|| {
        Finding::fault(
            "stuck",
            Reason::Stuck,
            format!("{name} stays the same to the last digit for {longest} samples"),
            "the estimate follows a sensor that measures nothing",
            "leave the fields empty where nothing was measured",
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a step is reported for an oscillating airspeed of 200 samples at the given times, with something added.
    fn told(added: impl Fn(usize) -> f64, time_us: impl Fn(i64) -> i64) -> bool {
        let sample = |k: usize| Sample {
            t_us: time_us(k as i64),
            input: [0.0; 2],
            measured: vec![Some(25.0 + (0.05 * k as f64).sin() + added(k))],
        };
        let log = Log::new(vec![2], (0..200).map(sample).collect()).expect("a log");
        check(&log, None).iter().any(|finding| finding.about == "steps")
    }

    #[test]
    fn a_pitch_rate_may_step_while_the_elevator_does_and_an_airspeed_may_not() {
        let told = |output: usize, elevator: f64| {
            let sample = |k: usize| {
                let stepped = if k >= 100 { 1.0 } else { 0.0 };
                let swing = 0.001 * (0.05 * k as f64).sin();
                let elevator = elevator * stepped + if k == 20 { 0.1 } else { 0.0 };
                Sample {
                    t_us: 20_000 * k as i64,
                    input: [elevator, 0.0],
                    measured: vec![Some(swing + stepped)],
                }
            };
            let log = Log::new(vec![output], (0..200).map(sample).collect()).expect("a log");
            check(&log, None).iter().any(|finding| finding.about == "steps")
        };
        assert!(told(1, 0.0) && !told(1, 0.05));
        assert!(told(2, 0.0) && told(2, 0.05));
    }

    #[test]
    fn a_step_that_stays_is_told_and_a_manoeuvre_or_a_gap_is_not() {
        let regular = |k| 20_000 * k;
        let from = |k: usize| k.saturating_sub(99) as f64;
        assert!(!told(|_| 0.0, regular));
        assert!(told(|k| 5.0 * from(k).min(1.0), regular));
        assert!(told(|k| -5.0 * from(k).min(1.0), regular));
        // Within a fifth of a second; once away and back; and where samples are missing.
        assert!(!told(|k| 0.5 * from(k).min(10.0), regular));
        assert!(!told(|k| if k == 100 { 5.0 } else { 0.0 }, regular));
        assert!(!told(
            |k| 5.0 * from(k).min(1.0),
            |k| 20_000 * k + if k >= 100 { 60_000 } else { 0 }
        ));
    }
}
