//! Warnings about the files, and about contradictions between them.

use kestirim_ppp_filter::Motion;
use kestirim_replay::gnss::{Epoch, FilterKind, Followed, Recording, Tally, names};

use crate::metrics::median;
use crate::systems::gnss::settings::Setup;

/// The warnings that are the same for all filters, derived from the results of one of them.
pub(super) fn of_recording(
    recording: &Recording,
    setup: &Setup,
    followed: &Followed,
) -> Vec<String> {
    let mut warnings: Vec<_> = recording.warnings(setup.corrections).collect();
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
    warnings.extend(gaps(recording, recording.epochs(setup.until)));
    warnings
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

/// A warning about epochs in which the two directions of a smoothed track disagree.
pub(super) fn apart(smoothed: &Followed, motion: Motion) -> Option<String> {
    let (first, count, of) = (smoothed.apart.first()?, smoothed.apart.len(), smoothed.fixes.len());
    let remedy = match motion {
        Motion::Static => ": was the receiver moved (--mode kinematic)?",
        Motion::Kinematic { .. } => "",
    };
    Some(format!(
        "in {count} of {of} smoothed epochs from {first} s on what came before and what came after disagree about the place{remedy}"
    ))
}

/// The warnings of all filters, with the names of the filters unless a warning applies to all.
pub(super) fn of_all(followed: &[(FilterKind, Followed)]) -> Vec<String> {
    let mut sentences: Vec<(String, Vec<&str>)> = Vec::new();
    for (filter, followed) in followed {
        for warning in followed.warnings() {
            match sentences.iter_mut().find(|(sentence, _)| *sentence == warning) {
                Some((_, names)) => names.push(filter.name()),
                None => sentences.push((warning, vec![filter.name()])),
            }
        }
    }
    let named = |(sentence, names): (String, Vec<&str>)| {
        if names.len() == followed.len() {
            sentence
        } else {
            format!("{}: {sentence}", names.join(", "))
        }
    };
    sentences.into_iter().map(named).collect()
}
