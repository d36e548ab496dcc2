//! Sky plots of the satellites.

use std::f64::consts::{FRAC_PI_4, TAU};

use kestirim_gnss_files::satellite_name;
use kestirim_gnss_ppp::Direction;
use kestirim_replay::gnss::Followed;

use super::arcs::{Arcs, Sighting};
use super::satellites::EVENTS;
use crate::figure::{Colour, Figure, Mark, Series};

/// The interval between the points of an arc (s), in which a satellite moves by half a degree.
const SPACING_S: f64 = 60.0;
/// The minimum duration (s) of an arc that is labelled: near the mask a satellite comes and goes.
const NAMED_S: f64 = 900.0;
/// The circles of elevation that are drawn (degrees).
const CIRCLES: [f64; 3] = [0.0, 30.0, 60.0];
/// The radius of the plot (degrees from the zenith): a little beyond the horizon, to leave room for the names of the
/// directions.
const EDGE: f64 = 106.0;

/// The sky above the antenna: the zenith in the middle, north at the top, east on the right, in degrees from the
/// zenith. `mask` is the elevation mask (rad).
pub fn sky(figure: Figure, followed: &Followed, arcs: &Arcs<'_>, mask: f64) -> Figure {
    let tracks = arcs.satellites().enumerate().map(|(place, (number, sightings))| {
        let (times, points): (Vec<_>, Vec<_>) =
            arcs.split(sightings).flat_map(arc_with_gap).unzip();
        Series::path(satellite_name(number), points).timed(times).coloured(Colour::Other(place))
    });
    let crosses = EVENTS.map(|(name, colour, of)| {
        // The gap after each makes the cursor select it at no other time.
        let marked = followed.residuals.iter().filter(|(_, report)| of(report));
        let marked = marked.flat_map(|(t, report)| [(*t, at(report.direction)), (*t, GAP)]);
        let (times, points): (Vec<_>, Vec<_>) = marked.unzip();
        Series::points(name, points).marked(Mark::Crosses).timed(times).coloured(colour)
    });
    let faint = |series: Series| Series { faint: true, ..series };
    let circles = CIRCLES.into_iter().flat_map(|elevation| circle(elevation).chain([GAP]));
    let axes = [[-90.0, 0.0], [90.0, 0.0], GAP, [0.0, -90.0], [0.0, 90.0]];
    let shown = Some([-EDGE, EDGE]);
    figure
        .axes("east, ° from the zenith", "north, ° from the zenith")
        .map()
        .showing(shown, shown)
        .with(faint(Series::path("horizon, 30°, 60°", circles.chain(axes)).coloured(Colour::Truth)))
        .with(
            Series::path("mask", circle(mask.to_degrees()))
                .marked(Mark::Dashes)
                .coloured(Colour::Limit),
        )
        .with(words(mask.to_degrees()))
        .with_all(tracks)
        .with(names(arcs))
        .with_all(crosses)
}

const GAP: [f64; 2] = [f64::NAN; 2];

/// The point of a direction in the plot.
fn at(Direction { elevation, azimuth }: Direction) -> [f64; 2] {
    let (sine, cosine) = azimuth.sin_cos();
    [sine, cosine].map(|part| (90.0 - elevation.to_degrees()) * part)
}

/// A circle of constant elevation (degrees).
fn circle(elevation: f64) -> impl Iterator<Item = [f64; 2]> {
    let elevation = elevation.to_radians();
    (0..=72).map(move |step| at(Direction { elevation, azimuth: TAU * f64::from(step) / 72.0 }))
}

/// An arc thinned to visible steps, followed by a gap.
fn arc_with_gap(arc: &[Sighting<'_>]) -> Vec<(f64, [f64; 2])> {
    let mut drawn: Vec<(f64, [f64; 2])> = Vec::new();
    let last = arc.len().saturating_sub(1);
    for (index, (t, report)) in arc.iter().enumerate() {
        // The tolerance allows for times that are rounded in files.
        if index == last || drawn.last().is_none_or(|(before, _)| t - before > SPACING_S - 0.1) {
            drawn.push((*t, at(report.direction)));
        }
    }
    drawn.extend(arc.last().map(|(t, _)| (*t, GAP)));
    drawn
}

/// The labels of satellites where they set.
fn names(arcs: &Arcs<'_>) -> Series {
    let (mut points, mut labels) = (Vec::new(), Vec::new());
    for (number, sightings) in arcs.satellites() {
        let end = sightings.last().map(|(t, _)| *t);
        for arc in arcs.split(sightings) {
            let (Some((first, _)), Some((last, report))) = (arc.first(), arc.last()) else {
                continue;
            };
            if last - first > NAMED_S || Some(*last) == end {
                points.push(at(report.direction));
                labels.push(satellite_name(number));
            }
        }
    }
    Series::points("names", points).marked(Mark::Dots).labelled(labels).coloured(Colour::Truth)
}

/// The labels of north, east, south and west and of the circles; gaps keep them from being joined by a line.
fn words(mask: f64) -> Series {
    let winds =
        [([0.0, 91.0], "N"), ([96.0, -3.0], "E"), ([0.0, -99.0], "S"), ([-96.0, -3.0], "W")];
    let winds = winds.map(|(place, name)| (place, name.to_owned()));
    let circles = [30.0, 60.0, mask].map(|elevation: f64| {
        let place = at(Direction { elevation: elevation.to_radians(), azimuth: FRAC_PI_4 });
        (place, format!("{elevation:.0}°"))
    });
    let all = winds.into_iter().chain(circles).flat_map(|it| [it, (GAP, String::new())]);
    let (points, labels): (Vec<_>, Vec<_>) = all.unzip();
    Series::path("directions", points).labelled(labels).coloured(Colour::Truth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_zenith_is_the_middle_and_east_on_the_right() {
        let place = |elevation: f64, azimuth: f64| {
            let [elevation, azimuth] = [elevation, azimuth].map(f64::to_radians);
            at(Direction { elevation, azimuth }).map(f64::round)
        };
        assert_eq!(place(90.0, 77.0).map(f64::abs), [0.0, 0.0]);
        assert_eq!(place(0.0, 0.0), [0.0, 90.0]);
        assert_eq!(place(30.0, 90.0), [60.0, 0.0]);
        assert_eq!(place(60.0, 180.0), [0.0, -30.0]);
        assert_eq!(place(45.0, 270.0), [-45.0, 0.0]);
    }
}
