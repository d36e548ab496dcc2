//! Samples that were not measured: repetitions of earlier ones, and rates of exactly zero, once or for a while.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

use kestirim_health::Reason;

use super::super::Sample;
use crate::Finding;

/// The time for which a stuck sensor repeats itself bit for bit, s.
const STUCK_S: f64 = 0.25;
/// The number of samples in a row that equal earlier ones bit for bit, from which on it is not chance.
const REPEATED: usize = 20;
/// The rate in the samples before and after, of the same sign, beyond which a rate of exactly zero was not measured,
/// rad/s.
const TURNING: f64 = 0.5;
/// The fewest such zeros that are reported; they must also be more than one in `ONE_IN` samples.
const ZEROS: usize = 3;
const ONE_IN: usize = 1000;

/// Whether all measurements of two samples are the same.
pub(super) fn same(a: &Sample, b: &Sample) -> bool {
    a.specific_force == b.specific_force && a.angular_rate == b.angular_rate
}

/// Runs of samples that are the same bit for bit: a bus that stalls, a buffer that is read again.
pub(super) fn stuck(samples: &[Sample]) -> Option<Finding> {
    let (mut runs, mut longest, mut lost, mut begin) = (0_usize, 0.0_f64, 0.0, 0_usize);
    for i in 1..=samples.len() {
        if i < samples.len() && same(&samples[i], &samples[begin]) {
            continue;
        }
        let seconds = (samples[i - 1].time_us - samples[begin].time_us) as f64 * 1e-6;
        if seconds >= STUCK_S {
            runs += 1;
            longest = longest.max(seconds);
            lost += seconds;
        }
        begin = i;
    }
    let times = if runs == 1 { "once".to_owned() } else { format!("{runs} times") };
    (runs > 0).then(|| {
        Finding::fault(
            "repeated samples",
            Reason::Stuck,
            format!(
                "the sensor repeated itself {times}, {lost:.1} s in all, {longest:.1} s at most"
            ),
            "what the foot did meanwhile is not in the log",
            "look at the bus and at the logger's buffer",
        )
    })
}

/// The longest block of samples that is repeated later: a buffer that was written twice.
pub(super) fn block(samples: &[Sample]) -> Option<Finding> {
    let mut seen: HashMap<u64, usize> = HashMap::new();
    let (mut count, mut at) = (0, None);
    let mut longest = (0, 0, 0);
    for (i, sample) in samples.iter().enumerate() {
        let values = sample.specific_force.iter().chain(&sample.angular_rate);
        let mut hasher = DefaultHasher::new();
        for value in values {
            value.to_bits().hash(&mut hasher);
        }
        let before = seen.insert(hasher.finish(), i);
        // Constant samples are reported as stuck instead.
        let before = before.filter(|before| before + 1 < i);
        let goes_on = before.is_some() && before == at.map(|at: usize| at + 1);
        count = if goes_on { count + 1 } else { usize::from(before.is_some()) };
        at = before;
        if let Some(before) = before.filter(|_| count > longest.0) {
            longest = (count, before, i);
        }
    }
    let (count, before, now) = longest;
    let seconds = |i: usize| (samples[i].time_us - samples[0].time_us) as f64 * 1e-6;
    // Rows that a recorder wrote twice have the earlier times, and steps without noise are the same from the first to
    // the last.
    let is_later = samples[now].time_us > samples[before].time_us && count <= now - before;
    (count >= REPEATED && is_later).then(|| {
        Finding::fault(
            "repeated block",
            Reason::Stuck,
            format!(
                "{count} samples that end at {:.2} s repeat those that end at {:.2} s bit for bit",
                seconds(now),
                seconds(before)
            ),
            "what the foot did in them is counted twice",
            "look at the logger's buffer",
        )
    })
}

/// Rates of exactly zero in the midst of a turn: a transfer from the sensor that failed.
pub(super) fn zeros(samples: &[Sample]) -> Option<Finding> {
    let is_zero = |three: &&[Sample]| {
        (0..3).any(|axis| {
            let [before, now, after] = [0, 1, 2].map(|i| three[i].angular_rate[axis]);
            now == 0.0 && before * after > 0.0 && before.abs().min(after.abs()) > TURNING
        })
    };
    let count = samples.windows(3).filter(is_zero).count();
    (count >= ZEROS && count * ONE_IN > samples.len()).then(|| {
        Finding::fault(
            "zeros",
            Reason::Rejected,
            format!("the gyroscope says exactly 0 {count} times in the midst of a turn"),
            "the heading misses what was turned meanwhile",
            "look at the bus: leave out what was not read",
        )
    })
}

/// An axis of the gyroscope that is exactly zero for a while in which the foot turns about another, and not otherwise.
pub(super) fn silent(samples: &[Sample]) -> Option<Finding> {
    let of_axis = |axis: usize| {
        let is_zero = |sample: &Sample| sample.angular_rate[axis] == 0.0;
        let count = samples.iter().filter(|it| is_zero(it)).count();
        let turns = |part: &[Sample]| {
            part.iter().flat_map(|it| it.angular_rate).any(|rate| rate.abs() > TURNING)
        };
        let runs = samples.chunk_by(|a, b| is_zero(a) == is_zero(b));
        let mut runs = runs.filter(|run| run.len() >= REPEATED && is_zero(&run[0]) && turns(run));
        let run = runs.next().filter(|_| 2 * count < samples.len())?;
        let (from, to) = (run[0].time_us, run[run.len() - 1].time_us);
        Some((axis, from, to.saturating_sub(from) as f64 * 1e-6))
    };
    let (axis, from, seconds) = (0..3).find_map(of_axis)?;
    let after = from.saturating_sub(samples[0].time_us) as f64 * 1e-6;
    Some(Finding::fault(
        "zeros",
        Reason::Stuck,
        format!(
            "the gyroscope's {} says exactly 0 for {seconds:.1} s from {after:.1} s on, while the foot turns",
            ["x", "y", "z"][axis]
        ),
        "the heading misses what was turned meanwhile",
        "look at the sensor and its bus: leave out what was not read",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A foot that swings, 100 Hz.
    fn swings(count: u64) -> Vec<Sample> {
        let sample = |k: u64| {
            let phase = 0.1 * k as f64;
            Sample {
                time_us: 10_000 * k,
                specific_force: [phase.sin(), 0.01 * phase, 9.8],
                angular_rate: [2.0 + phase.cos(), 0.0, 0.02 * phase],
            }
        };
        (0..count).map(sample).collect()
    }

    #[test]
    fn a_block_that_comes_again_is_told() {
        let mut samples = swings(400);
        assert!(block(&samples).is_none());
        for k in 200..219 {
            samples[k] = Sample { time_us: samples[k].time_us, ..samples[k - 100] };
        }
        assert!(block(&samples).is_none(), "nineteen may be chance");
        for k in 219..230 {
            samples[k] = Sample { time_us: samples[k].time_us, ..samples[k - 100] };
        }
        let found = block(&samples).expect("a finding");
        assert!(
            found.found.contains("30 samples that end at 2.29 s repeat those that end at 1.29 s"),
            "{found:?}"
        );
    }

    #[test]
    fn an_axis_that_falls_silent_while_another_turns_is_told() {
        let silenced = |from: usize, to: usize, turning: f64| {
            let mut samples = swings(400);
            for sample in &mut samples {
                sample.angular_rate[1] = 0.3;
                sample.angular_rate[0] *= turning;
            }
            for sample in &mut samples[from..to] {
                sample.angular_rate[1] = 0.0;
            }
            silent(&samples).is_some()
        };
        assert!(silenced(200, 220, 1.0));
        assert!(!silenced(200, 219, 1.0), "nineteen may be chance");
        assert!(!silenced(200, 220, 0.1), "a foot that stands");
        assert!(!silenced(0, 400, 1.0), "a dead axis is another matter");
    }

    #[test]
    fn rates_of_zero_are_none_in_a_turn() {
        let mut samples = swings(400);
        for k in [50, 150] {
            samples[k].angular_rate[0] = 0.0;
        }
        assert!(zeros(&samples).is_none(), "two");
        samples[250].angular_rate[0] = 0.0;
        assert!(zeros(&samples).is_some());
    }
}
