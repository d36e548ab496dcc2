//! A plan of the positions on the ground.

use kestirim_replay::gnss::{BEGINNING, Followed};
use nalgebra::Vector3;

use super::arcs::Arcs;
use crate::figure::{Colour, Figure, Mark, Series};
use crate::metrics::median;

/// The spread of the positions, in standard deviations, beyond which the receiver counts as moving.
const MOVING: f64 = 10.0;

/// A time (s), and a position to the east and north (m).
type Place = (f64, [f64; 2]);

/// The positions on the ground relative to a point named `origin`: dots, or a path if the receiver moves.
pub fn plan(
    figure: Figure,
    followed: &Followed,
    arcs: &Arcs<'_>,
    (origin, about): (&str, &Vector3<f64>),
) -> Figure {
    let begin = followed.fixes.first().map_or(0.0, |fix| fix.t);
    let places = followed.fixes.iter().zip(followed.enu_from(about));
    let places: Vec<_> = places.map(|(fix, [e, n, _])| (fix.t, [e, n])).collect();
    let moves = moves(followed, &places);
    let (early, late) = places.split_at(places.partition_point(|(t, _)| *t < begin + BEGINNING));
    // The initial positions are metres off, which does not matter in a path. A short recording has no others to show.
    let hides = !moves && !late.is_empty();
    let drawn = |name: &str, places: &[Place]| {
        if moves { path(name, places, arcs.longest_gap) } else { dots(name, places) }
    };
    let first = drawn("first hour", early).coloured(Colour::Other(1));
    let first = if hides { first.hidden() } else { first };
    let shown = if hides { late } else { &places };
    let shown: Vec<_> = shown.iter().map(|(_, place)| *place).chain([[0.0, 0.0]]).collect();
    figure
        .axes(format!("east of {origin}, m"), format!("north of {origin}, m"))
        .map()
        .with(first)
        .with(drawn("after it", late))
        .with(Series::points("origin", [[0.0, 0.0]]).coloured(Colour::Truth))
        .with(scale(&shown))
}

/// Whether most positions are far from their median, relative to their standard deviations.
fn moves(followed: &Followed, places: &[Place]) -> bool {
    let along = |axis: usize| median(&places.iter().map(|(_, it)| it[axis]).collect::<Vec<_>>());
    let middle = [along(0), along(1)];
    let far = places.iter().map(|(_, [e, n])| (e - middle[0]).hypot(n - middle[1]));
    let told = followed.deviations.iter().map(|[east, north, _]| east.hypot(*north));
    median(&far.collect::<Vec<_>>()) > MOVING * median(&told.collect::<Vec<_>>())
}

fn dots(name: &str, places: &[Place]) -> Series {
    let dots = Series::points(name, places.iter().map(|(_, place)| *place)).marked(Mark::Dots);
    dots.timed(places.iter().map(|(t, _)| *t))
}

/// A line that is interrupted where positions are missing for longer than `longest` (s).
fn path(name: &str, places: &[Place], longest: f64) -> Series {
    let pieces = places.chunk_by(|(a, _), (b, _)| b - a <= longest);
    let pieces = pieces.flat_map(|piece| {
        let end = piece.last().map(|(t, _)| (*t, [f64::NAN; 2]));
        piece.iter().copied().chain(end)
    });
    let (times, points): (Vec<_>, Vec<_>) = pieces.unzip();
    Series::path(name, points).timed(times)
}

/// A scale bar of a round length, at most a third of the positions' extent, below them on the left, with its length.
fn scale(places: &[[f64; 2]]) -> Series {
    let ends = |axis: usize| {
        let along = places.iter().map(|place| place[axis]);
        [along.clone().fold(f64::INFINITY, f64::min), along.fold(f64::NEG_INFINITY, f64::max)]
    };
    let ([left, right], [low, high]) = (ends(0), ends(1));
    let extent = (right - left).max(high - low).max(1e-3);
    let length = round_below(extent / 3.0);
    let below = low - 0.08 * extent;
    let tick = below + 0.02 * extent;
    let points = [
        [left, tick],
        [left, below],
        [left + length / 2.0, below],
        [left + length, below],
        [left + length, tick],
    ];
    let mut labels = vec![String::new(); points.len()];
    labels[2] = in_words(length);
    Series::path("scale", points).labelled(labels).coloured(Colour::Truth)
}

/// The greatest product of 1, 2 or 5 and a power of ten that is not above a length.
fn round_below(length: f64) -> f64 {
    let decade = 10_f64.powf(length.log10().floor());
    let steps = [5.0, 2.0].map(|step| step * decade);
    steps.into_iter().find(|step| *step <= length).unwrap_or(decade)
}

/// A round length with its unit, as text.
fn in_words(metres: f64) -> String {
    match metres {
        1e3.. => format!("{:.0} km", metres / 1e3),
        0.999.. => format!("{metres:.0} m"),
        0.0099.. => format!("{:.0} cm", 1e2 * metres),
        0.000_99.. => format!("{:.0} mm", 1e3 * metres),
        _ => format!("{:.1} mm", 1e3 * metres),
    }
}

#[cfg(test)]
mod tests {
    use kestirim_replay::gnss::Fix;

    use super::*;

    #[test]
    fn bars_are_round_and_say_how_long() {
        for (extent, words) in [
            (0.001, "0.2 mm"),
            (0.01, "2 mm"),
            (0.05, "1 cm"),
            (0.9, "20 cm"),
            (3.1, "1 m"),
            (1700.0, "500 m"),
            (7000.0, "2 km"),
        ] {
            let bar = scale(&[[0.0, 0.0], [extent, -extent / 2.0]]);
            let labels = bar.labels.unwrap();
            assert_eq!(labels[2], words, "{extent}");
            let length = bar.x[3] - bar.x[1];
            assert!(length <= extent / 3.0 + 1e-12 && length > extent / 8.0, "{extent}: {length}");
            assert!(bar.y.iter().all(|y| *y < -extent / 2.0), "{:?}", bar.y);
        }
        assert!(scale(&[[2.0, 2.0]]).x.iter().all(|x| x.is_finite()));
    }

    /// A drive of two hours from the equator to the north at a constant speed, with each position known to 5 cm, and a
    /// gap of 10 minutes.
    fn drive(metres_per_second: f64) -> Followed {
        let mut followed = Followed::default();
        for t in (0..240).map(|k| 30.0 * f64::from(k)).filter(|t| !(1000.0..1600.0).contains(t)) {
            let scatter = 0.05 * t.sin();
            let position = Vector3::new(6_378_137.0, scatter, metres_per_second * t);
            followed.fixes.push(Fix { t, position });
            followed.deviations.push([0.05; 3]);
        }
        followed
    }

    #[test]
    fn a_receiver_that_moves_leaves_a_path_and_one_at_rest_dots() {
        for (speed, mark, hides) in [(0.5, Mark::Line, false), (0.0, Mark::Dots, true)] {
            let followed = drive(speed);
            let arcs = Arcs::of(&followed);
            let about = followed.fixes[0].position;
            let figure = plan(Figure::new("", ""), &followed, &arcs, ("its begin", &about));
            let [first, late, ..] = &figure.series[..] else { panic!("{:?}", figure.series) };
            assert_eq!((first.mark, late.mark, first.hidden), (mark, mark, hides));
            let gaps = |series: &Series| series.x.iter().filter(|x| x.is_nan()).count();
            let expected = if mark == Mark::Line { (2, 1) } else { (0, 0) };
            assert_eq!((gaps(first), gaps(late)), expected);
            assert_eq!(first.times.as_ref().map(Vec::len), Some(first.x.len()));
        }
    }
}
