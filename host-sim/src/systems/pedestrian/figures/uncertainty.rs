//! Figures of the height over time, and of the uncertainty of the position.

use kestirim_replay::pedestrian::{TrackPoint, position_at};

use super::{Placed, is_continuous, seconds};
use crate::figure::{Colour, Figure, Mark, Series};
use crate::metrics::distance;

/// The standard deviations of the position over time, beside the true error.
pub(super) fn draw(ours: &Placed<'_>, truth: &[TrackPoint]) -> Figure {
    let walk = &ours.trace.walk;
    let begin = walk.track.first().map(|point| point.time_us);
    let end = walk.track.last().map(|point| point.time_us);
    let strides = walk.strides.iter().map(|stride| stride.time_us);
    let times: Vec<_> = begin.into_iter().chain(strides).chain(end).collect();
    let sigmas: Vec<_> = walk.sigmas_m(times.iter().copied()).collect();
    let steps = |name: &str, sigma: fn(&[f64; 3]) -> f64| {
        let times = times.iter().map(|time| seconds(*time)).collect();
        Series::new(name, Mark::Steps, times, sigmas.iter().map(sigma).collect())
    };
    Figure::new("uncertainty", "Uncertainty of the position")
        .over_seconds("m")
        .caption(
            "One standard deviation, as the tracker tells it: it grows from stride to stride. Where the truth is known, \
             so is the error, after the path is turned onto it.",
        )
        .with_all(error(ours, truth))
        .with(steps("horizontal", |[x, y, _]| x.hypot(*y)).coloured(Colour::Ours))
        .with(steps("height", |[.., z]| *z).coloured(Colour::Other(2)))
}

/// The horizontal error of the path over time; `None` without a truth.
fn error(ours: &Placed<'_>, truth: &[TrackPoint]) -> Option<Series> {
    let errors = truth.iter().filter_map(|point| {
        let [x, y, _] = position_at(&ours.trace.walk.track, point.time_us)?;
        let error = distance(ours.placement.onto_plan([x, y]), point.horizontal());
        Some((seconds(point.time_us), error))
    });
    let (times, errors): (Vec<_>, Vec<_>) = errors.unzip();
    let mark = if is_continuous(truth) { Mark::Line } else { Mark::LineAndPoints };
    let error = Series::new("error, horizontal", mark, times, errors).coloured(Colour::Truth);
    (!truth.is_empty()).then_some(error)
}

/// The height over time, with a band of one standard deviation, and the truth if it has heights.
pub(super) fn height(ours: &Placed<'_>, truth: &[TrackPoint]) -> Figure {
    let walk = &ours.trace.walk;
    let line = |points: &[TrackPoint]| -> (Vec<f64>, Vec<f64>) {
        points.iter().map(|point| (seconds(point.time_us), point.position[2])).unzip()
    };
    let truth = is_continuous(truth).then(|| {
        let (times, heights) = line(truth);
        Series::new("truth", Mark::Dashes, times, heights).coloured(Colour::Truth)
    });
    let bound = |name: &str, by: f64| {
        let strides = walk.strides.iter();
        let ends = strides.map(|it| (seconds(it.time_us), it.position[2] + by * it.sigma_m[2]));
        let (times, heights) = ends.unzip();
        Series::new(name, Mark::Dashes, times, heights).coloured(Colour::Limit)
    };
    let (times, heights) = line(&walk.track);
    Figure::new("height", "Height")
        .over_seconds("height, m")
        .caption(
            "A hump a stride where the foot is lifted; on stairs, a step a stride. Between the dashes lies one standard \
             deviation to either side of where it stands.",
        )
        .with_all(truth)
        .with(bound("+ σ", 1.0))
        .with(bound("− σ", -1.0))
        .with(Series::line("ours", times, heights).coloured(Colour::Ours))
}
