//! Doubts and warnings about the solution of a recording.

use kestirim_gnss_ppp::Corrections;
use kestirim_health::{Health, Reason};
use kestirim_ppp_filter::{Contradiction, Motion};

use super::coverage::names;
use super::followed::{Followed, Tally};
use super::model::Epoch;
use super::recording::{POOR, Recording};
use crate::metrics::median;

impl Recording {
    /// The warnings about the files, and about those of these epochs, as they were followed: missing orbits and clocks, and gaps.
    pub fn warnings_of(
        &self,
        corrections: Corrections,
        epochs: &[Epoch],
        followed: &Followed,
    ) -> Vec<String> {
        let mut warnings: Vec<_> = self.warnings(corrections).collect();
        let mut lacking = |what: &str, count: fn(&Tally) -> usize| {
            let some = followed.satellites.iter().filter(|(_, tally)| count(tally) > 0);
            let total: usize = some.clone().map(|(_, tally)| count(tally)).sum();
            if total > 0 {
                let names = names(some.map(|(&prn, _)| prn));
                let plural = if total == 1 { "" } else { "s" };
                warnings.push(format!("{total} observation{plural} without {what}: {names}"));
            }
        };
        lacking("an orbit", |tally| tally.no_orbit);
        lacking("a clock", |tally| tally.no_clock);
        warnings.extend(gaps(self, epochs));
        warnings
    }
}

/// A warning about missing epochs.
fn gaps(recording: &Recording, epochs: &[Epoch]) -> Option<String> {
    let steps: Vec<f64> = epochs.windows(2).map(|pair| pair[1].time.since(pair[0].time)).collect();
    let rounded = |seconds: f64| (1e3 * seconds).round() / 1e3;
    let usual = rounded(median(&steps));
    let long = || steps.iter().enumerate().filter(|(_, step)| **step > 1.5 * usual);
    let (first, _) = long().next()?;
    let longest = rounded(long().map(|(_, step)| *step).fold(0.0, f64::max));
    let at = rounded(recording.seconds(&epochs[first]));
    let (count, plural) = (long().count(), if long().count() == 1 { "" } else { "s" });
    Some(format!(
        "{count} gap{plural} between epochs every {usual} s: the first after {at} s, the longest of {longest} s"
    ))
}

impl Followed {
    /// The doubts about the whole solution, whatever its epochs say of themselves: many epochs without a solution.
    pub fn doubts(&self) -> Health {
        let (without, with) = (self.outages.count(), self.fixes.len());
        let are_many = without as f64 > POOR * (without + with) as f64;
        Health::GOOD.with(Reason::Dropout, are_many)
    }

    /// A sentence for each kind of epoch without a solution, and about contradictions, useless phases and jumps of the
    /// clock.
    pub fn warnings(&self) -> Vec<String> {
        let phases = phases_of_no_use(self);
        let told = contradicted(self).into_iter().chain(phases).chain(clock_jumps(self));
        self.outages.warnings().chain(told).collect()
    }

    /// A warning about epochs of a smoothed track in which the two directions disagree.
    pub fn disagreement(&self, motion: Motion) -> Option<String> {
        let (first, count, of) = (self.apart.first()?, self.apart.len(), self.fixes.len());
        let remedy = match motion {
            Motion::Static => ": was the receiver moved (--mode kinematic)?",
            Motion::Kinematic { .. } => "",
        };
        Some(format!(
            "in {count} of {of} smoothed epochs from {first} s on what came before and what came after disagree about the place{remedy}"
        ))
    }
}

/// A sentence about epochs whose observations contradict the solution.
fn contradicted(followed: &Followed) -> Option<String> {
    let (first, contradiction) = followed.contradictions().next()?;
    let (count, of) = (followed.contradictions().count(), followed.fixes.len());
    let share = 100.0 * followed.rejected.sum() as f64 / followed.observations.max(1) as f64;
    let (why, therefore) = match contradiction {
        Contradiction::Motion => (
            "the receiver is not where it was before",
            "if moved, --mode kinematic; if not, positions are wrong",
        ),
        Contradiction::Residuals => {
            ("the observations contradict the solution", "positions and σ there are wrong")
        }
        Contradiction::Rejections => (
            "more than a tenth of the observations is rejected",
            "positions and σ there may be wrong",
        ),
    };
    Some(format!(
        "in {count} of {of} epochs from {first} s on {why} ({share:.0} % rejected): {therefore}; \
         check times, products, codes and antennas"
    ))
}

/// A sentence about phases whose ambiguities begin anew all the time.
fn phases_of_no_use(followed: &Followed) -> Option<String> {
    /// The largest share without a warning; in a street or under trees it is about one in thirty.
    const MOST: f64 = 0.2;
    let share = 2.0 * followed.slips.sum() as f64 / followed.observations.max(1) as f64;
    (share > MOST).then(|| {
        format!(
            "{:.0} % of the phases begin anew, so that positions are hardly better than of codes alone: check the phases' units and \
             order, and the flags of lost lock",
            100.0 * share
        )
    })
}

/// A sentence about jumps of the receiver's clock that were repaired.
fn clock_jumps(followed: &Followed) -> Option<String> {
    let (first, milliseconds) = followed.clock_jumps.first()?;
    let more = match followed.clock_jumps.len() - 1 {
        0 => String::new(),
        count => format!(", and {count} times more"),
    };
    Some(format!(
        "at {first} s all phases jump by {milliseconds} ms against their codes{more}: repaired"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gnss::{Fix, Outage, Slips, Unused};
    use kestirim_ppp_filter::Error;
    use nalgebra::Vector3;

    fn of(with: usize, without: usize) -> Followed {
        let fix = Fix { t: 0.0, position: Vector3::zeros() };
        let mut followed = Followed { fixes: vec![fix; with], ..Followed::default() };
        let outage = Outage { error: Error::TooFewSatellites, t: 0.0, unused: Unused::default() };
        (0..without).for_each(|_| followed.outages.add(outage));
        followed
    }

    #[test]
    fn more_than_a_tenth_without_a_solution_is_doubted() {
        assert_eq!(of(90, 10).doubts(), Health::GOOD);
        assert_eq!(of(89, 11).doubts(), Reason::Dropout.into());
    }

    #[test]
    fn phases_that_begin_anew_all_the_time_are_told() {
        let with_slips = |loss_of_lock| Followed {
            observations: 200,
            slips: Slips { loss_of_lock, ..Slips::default() },
            ..of(10, 0)
        };
        assert_eq!(with_slips(20).warnings(), [""; 0]);
        let warnings = with_slips(21).warnings();
        assert!(warnings[0].starts_with("21 % of the phases begin anew"), "{warnings:?}");
    }
}
