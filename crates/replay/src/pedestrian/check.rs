//! Checks of the log of a walk before it is tracked.

mod repeated;
mod rest;
mod spikes;

use kestirim_health::Reason;
use kestirim_import::inertial::turns;

use super::Sample;
use crate::Finding;
use crate::metrics::median;

/// The time between samples, in usual steps, above which others are missing between them.
const GAP: f64 = 3.0;
/// The fewest samples at an axis's largest value from which that value is the sensor's limit.
const CLIPPED: usize = 3;
/// The values above which such a limit is credible: 1.8 g in m/s², and 200 °/s in rad/s.
const FAR_OUT: [f64; 2] = [1.8 * 9.806_65, 3.49];
/// The measurement ranges of common sensors: g and °/s.
const RANGES: [&[f64]; 2] =
    [&[2.0, 4.0, 6.0, 8.0, 16.0, 24.0, 32.0], &[250.0, 300.0, 450.0, 500.0, 1000.0, 2000.0]];
/// The factor by which the measured turns must be scaled to fit gravity, from which on it may be a fault.
const OTHER_FACTOR: f64 = 1.25;
/// How many times better the scaled turns must fit gravity.
const BETTER: f64 = 1.5;
/// The largest error, relative to gravity, with which the scaled turns fit well.
const WELL: f64 = 0.12;

/// The findings about the samples.
pub fn check(samples: &[Sample]) -> Vec<Finding> {
    let steps: Vec<f64> = samples
        .windows(2)
        .map(|pair| (pair[1].time_us - pair[0].time_us) as f64 * 1e-6)
        .filter(|step| *step > 0.0)
        .collect();
    let usual = median(&steps);
    if steps.is_empty() {
        return vec![Finding::note("rate", "one sample")];
    }
    let mut findings = vec![rate(&steps, usual)];
    findings.extend(gaps(&steps, usual));
    findings.extend(repeated::stuck(samples));
    findings.extend(repeated::block(samples));
    findings.extend(repeated::zeros(samples));
    findings.extend(repeated::silent(samples));
    findings.extend(clipped(samples));
    findings.extend(spikes::find(samples));
    findings.extend(rest::check(samples, usual));
    findings.extend(turned(samples));
    findings
}

fn rate(steps: &[f64], usual: f64) -> Finding {
    let off: Vec<f64> = steps.iter().map(|step| (step - usual).abs()).collect();
    let found = format!("{:.1} Hz, usual jitter {:.2} ms", 1.0 / usual, 1e3 * median(&off));
    if usual > 0.04 {
        return Finding::fault(
            "rate",
            Reason::Dropout,
            found,
            "a footprint has too few samples to be found surely",
            "log at 50 Hz or more, 100 Hz or more of a running foot",
        );
    }
    Finding::note("rate", found)
}

fn gaps(steps: &[f64], usual: f64) -> Option<Finding> {
    let gaps: Vec<f64> = steps.iter().copied().filter(|step| *step > GAP * usual).collect();
    let longest = gaps.iter().copied().fold(0.0, f64::max);
    let found = format!("{} gaps, the longest {longest:.2} s", gaps.len());
    // Gaps are noted only: short ones hardly change a path.
    (!gaps.is_empty()).then(|| Finding::note("gaps", found))
}

/// Axes that saturate at their limit.
fn clipped(samples: &[Sample]) -> Vec<Finding> {
    // A peak that a sensor repeats is not saturation: at its limit one axis stays constant, and others continue.
    let mut samples = samples.to_vec();
    samples.dedup_by(|a, b| repeated::same(a, b));
    let axis = |sensor: usize, axis: usize| {
        let value = move |sample: &Sample| {
            if sensor == 0 { sample.specific_force[axis] } else { sample.angular_rate[axis] }
        };
        let most = samples.iter().map(|sample| value(sample).abs()).fold(0.0, f64::max);
        let at_end = |sample: &&Sample| value(sample).abs() >= most * (1.0 - 1e-4);
        let count = samples.iter().filter(at_end).count();
        // Neighbours at the end: an impact reaches its peak once.
        let together = samples
            .windows(2)
            .filter(|pair| pair.iter().all(|sample| value(sample).abs() >= most * (1.0 - 1e-4)))
            .count();
        (most, count, together)
    };
    let mut findings = Vec::new();
    for (sensor, name, unit, scale) in [
        (0, "accelerometer", "g", 1.0 / 9.806_65),
        (1, "gyroscope", "°/s", 180.0 / std::f64::consts::PI),
    ] {
        let clipped: Vec<_> = (0..3)
            .map(|i| (i, axis(sensor, i)))
            .filter(|(_, (most, count, together))| {
                *most > FAR_OUT[sensor] && *count >= CLIPPED && *together > 0
            })
            .collect();
        let Some(&(_, (most, ..))) = clipped.iter().max_by(|a, b| a.1.0.total_cmp(&b.1.0)) else {
            continue;
        };
        let share = |count: usize| 100.0 * count as f64 / samples.len() as f64;
        let each: Vec<_> = clipped
            .iter()
            .map(|(i, (_, count, _))| format!("{} {:.2} %", ["x", "y", "z"][*i], share(*count)))
            .collect();
        let end = most * scale;
        let next = RANGES[sensor].iter().find(|range| **range > end * 1.03);
        let remedy = match next {
            Some(range) => format!("set the sensor to ±{range} {unit}"),
            None => "take a sensor with a wider range".to_owned(),
        };
        findings.push(Finding::fault(
            "clipping",
            Reason::Saturated,
            format!("the {name} saturated at {end:.0} {unit} ({})", each.join(", ")),
            "strides come out too short or bent",
            remedy,
        ));
    }
    findings
}

/// Whether the measured turns are as large as gravity shows them.
fn turned(samples: &[Sample]) -> Option<Finding> {
    let turns = turns(samples)?;
    let apart = turns.factor.max(1.0 / turns.factor);
    if apart < OTHER_FACTOR || turns.error > WELL || turns.error_as_measured < BETTER * turns.error
    {
        return Some(Finding::note(
            "turns",
            format!(
                "{:.0} % of gravity left in disagreement over {} stretches",
                100.0 * turns.error_as_measured,
                turns.stretches
            ),
        ));
    }
    Some(Finding::fault(
        "turns",
        Reason::Time,
        format!("turns have to be {:.2} times as large to agree with gravity", turns.factor),
        "strides and their directions come out wrong",
        "look at the times (--units t=…) and at the gyroscope's scale (--units gyro=…)",
    ))
}
