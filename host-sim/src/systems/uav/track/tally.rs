//! Whether measurements and model agree, line by line.

use crate::system::{HealthState, Reason};

/// What one line says of that.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tally {
    /// How many outputs were measured.
    pub measured: usize,
    /// How many of them contradicted the estimate and were left out.
    pub left_out: u32,
    /// Sum of the outputs' normalised innovations squared, each no more than [`Self::MOST`].
    pub nis: f64,
}

impl Tally {
    /// A spike is one measurement and counts as one.
    pub const MOST: f64 = 10.0;
    /// Lines over which it is counted how many measurements were left out …
    const LINES: usize = 50;
    /// … and the share of them beyond which the estimate is worth less.
    const SHARE: f64 = 0.1;
    /// Lines over which the mean normalised innovation squared is taken …
    const NIS_LINES: usize = 200;
    /// … and what it is at most if model and noise are right. It is 1 on average, and of a hundred measurements
    /// within 1.6 with 99.9 %; noise of one and a half times what was said is no reason to doubt.
    const NIS: f64 = 2.25;
}

/// Why the estimate of each line is to be doubted.
pub fn doubts(tallies: &[Tally]) -> Vec<Option<Reason>> {
    let of = |last: usize| {
        let recent = |lines: usize| &tallies[(last + 1).saturating_sub(lines)..=last];
        let measured =
            |tallies: &[Tally]| tallies.iter().map(|it| it.measured).sum::<usize>() as f64;
        let long = recent(Tally::NIS_LINES);
        let nis: f64 = long.iter().map(|it| it.nis).sum();
        if long.len() == Tally::NIS_LINES && nis > Tally::NIS * measured(long) {
            return Some(Reason::Innovations);
        }
        let short = recent(Tally::LINES);
        let left_out: u32 = short.iter().map(|it| it.left_out).sum();
        (f64::from(left_out) > Tally::SHARE * measured(short)).then_some(Reason::Rejected)
    };
    (0..tallies.len()).map(of).collect()
}

/// How far the estimate of each line can be relied upon.
pub fn healths(tallies: &[Tally]) -> Vec<HealthState> {
    let state = |doubt: Option<Reason>| doubt.map_or(HealthState::Good, Reason::state);
    doubts(tallies).into_iter().map(state).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_large_innovations_are_doubted_once_there_are_enough_of_them() {
        let line = |nis| Tally { measured: 3, left_out: 0, nis };
        let mut tallies = vec![line(3.0); 400];
        tallies.extend(vec![line(12.0); 400]);
        let doubts = doubts(&tallies);
        assert!(doubts[..430].iter().all(Option::is_none));
        assert!(doubts[500..].iter().all(|doubt| *doubt == Some(Reason::Innovations)));
    }

    #[test]
    fn what_is_left_out_is_doubted_while_it_is_much() {
        let mut tallies = vec![Tally { measured: 2, left_out: 0, nis: 2.0 }; 300];
        for tally in &mut tallies[100..120] {
            tally.left_out = 1;
        }
        let healths = healths(&tallies);
        assert_eq!(healths[99], HealthState::Good);
        assert_eq!(healths[119], HealthState::Degraded);
        assert_eq!(healths[170], HealthState::Good);
    }
}
