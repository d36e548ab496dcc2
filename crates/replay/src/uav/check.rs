//! What the log of a flight shows before an estimator follows it.

use kestirim_health::Reason;

use super::{Log, Model, STATE_COLUMNS};
use crate::Finding;
use crate::metrics::median;

/// A measurement that jumps by so many usual changes and back is a spike.
const SPIKE: f64 = 30.0;
/// Share of spikes from which on they are told as a fault.
const MANY: f64 = 0.002;
/// So many samples in a row that stay the same to the last digit while others change are stuck.
const STUCK: usize = 50;

/// What the log shows. Outputs are named by the model, or without one are the states.
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
        .map(|column| {
            log.samples.iter().filter_map(|s| s.measured.get(column).copied().flatten()).collect()
        })
        .collect();
    let steers = log.samples.windows(2).any(|pair| pair[0].input != pair[1].input);
    let flies = steers || columns.iter().any(|values| varies(values));
    for (values, &output) in columns.iter().zip(&log.outputs) {
        let name = name(output);
        let missing = count - values.len();
        if missing > 0 {
            let share = 100.0 * missing as f64 / count as f64;
            findings.push(Finding::note("missing", format!("{name}: {share:.1} % of the samples")));
        }
        findings.extend(spikes(name, values));
        findings.extend(stuck(name, values).filter(|_| flies));
    }
    findings
}

fn spikes(name: &str, values: &[f64]) -> Option<Finding> {
    let changes: Vec<f64> = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    // Without changes of nothing: of a sensor that is stuck for half of the flight the usual change would be none, and any of the
    // other half a spike.
    let limit = SPIKE * median(&changes.iter().copied().filter(|it| *it > 0.0).collect::<Vec<_>>());
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
