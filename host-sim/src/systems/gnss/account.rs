//! The results of a recording.

pub mod comparison;
pub mod report;
pub mod tables;
mod warning;

use kestirim_ppp_filter::Health;
use kestirim_replay::gnss::{FilterKind, Followed, Recording};

use self::comparison::Comparison;
use self::report::Report;
use super::Gnss;
use super::settings::{Choice, Mode, Setup};
use super::track::Track;
use crate::Error;
use crate::system::{Account, System};

/// Adds the reasons why the solutions cannot be relied upon.
fn doubt(account: &mut Account, track: &Track) {
    let filters = track.filters.iter().map(|(_, followed)| followed);
    let contradicted = filters.chain(&track.smoothed).flat_map(Followed::contradictions);
    for (_, contradiction) in contradicted {
        let doubts = Health::Contradicted(contradiction).in_short();
        doubts.reasons().for_each(|reason| account.doubt(reason));
    }
    track.main().doubts().reasons().for_each(|reason| account.doubt(reason));
}

/// The account of one filter, or of all.
pub(super) fn account(
    recording: &Recording,
    setup: &Setup,
    track: &Track,
) -> Result<Account, Error> {
    // Warnings about the recording are the same for all filters.
    let epochs = recording.epochs(setup.until);
    let mut warnings = recording.warnings_of(setup.corrections, epochs, track.main());
    warnings.extend(track.smoothed.iter().find_map(|it| it.disagreement(setup.motion)));
    let of = |(filter, followed): &(FilterKind, Followed), first: &[String]| {
        let smoothed = track.smoothed.as_ref().filter(|_| *filter == setup.main());
        let warnings = [first, &followed.warnings()].concat();
        Report::new(recording, setup, *filter, followed, smoothed, warnings)
    };
    if setup.filter == Choice::All {
        let comparison = Comparison {
            system: Gnss::NAME,
            mode: Mode::of(setup.motion),
            epochs: track.main().epochs,
            filters: track.filters.iter().filter_map(|filter| of(filter, &[])).collect(),
            warnings: [warnings, warning::of_all(&track.filters)].concat(),
        };
        let mut account = Account::new(&comparison, comparison.warnings.clone())?;
        account.text = Some(comparison.to_string());
        doubt(&mut account, track);
        for report in &comparison.filters {
            account.fact(report.title(), report.in_a_line());
        }
        return Ok(account);
    }
    // A filter without a position has no report.
    let mut reports = track.filters.iter().filter_map(|filter| of(filter, &warnings));
    let Some(report) = reports.next() else { return Ok(Account::default()) };
    let mut account = Account::new(&report, report.warnings.clone())?;
    for (name, value) in report.facts() {
        account.fact(name, value);
    }
    doubt(&mut account, track);
    Ok(account)
}
