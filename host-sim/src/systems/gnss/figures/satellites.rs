//! A figure of when satellites were used.

use kestirim_ppp_filter::{SatelliteReport, Slipped};
use kestirim_replay::gnss::Followed;

use super::arcs::{Arcs, is_rejected};
use crate::figure::{Colour, Figure, Mark, Series};

/// An event of a satellite: its name, its colour, and whether it occurred.
pub(super) type Event = (&'static str, Colour, fn(&SatelliteReport) -> bool);

/// The events that are marked.
pub(super) const EVENTS: [Event; 3] = [
    ("code rejected", Colour::Other(1), |report| is_rejected(&report.code)),
    ("phase rejected", Colour::Alarm, |report| is_rejected(&report.phase)),
    ("ambiguity anew", Colour::Other(3), |report| {
        !matches!(report.slipped, None | Some(Slipped::New))
    }),
];

/// The times at which each satellite was used, at which its observations were rejected, and at which its ambiguity was
/// reset.
pub fn satellites(figure: Figure, followed: &Followed, arcs: &Arcs<'_>) -> Figure {
    let used = arcs.satellites().flat_map(|(number, sightings)| {
        let at = move |t: f64| [t / 3600.0, f64::from(number)];
        let ends = arcs.split(sightings).filter_map(|arc| Some((arc.first()?.0, arc.last()?.0)));
        ends.flat_map(move |(first, last)| [at(first), at(last), [f64::NAN; 2]])
    });
    let events = EVENTS.map(|(name, colour, of)| {
        let marked = followed.residuals.iter().filter(|(_, report)| of(report));
        let points = marked.map(|(t, report)| [t / 3600.0, f64::from(report.satellite)]);
        let mark = if name == "ambiguity anew" { Mark::Points } else { Mark::Dots };
        Series::points(name, points).marked(mark).coloured(colour)
    });
    let used = Series::path("used", used).coloured(Colour::Truth);
    figure.over_hours("satellite (PRN)").with(used).with_all(events)
}
