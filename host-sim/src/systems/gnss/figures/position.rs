//! Positions and their uncertainty over time, in hours.

use kestirim_replay::gnss::Followed;
use nalgebra::Vector3;

use super::hours;
use crate::figure::{Colour, Figure, Mark, Series};

/// The names of the axes of positions.
const AXES: [&str; 3] = ["east", "north", "up"];
/// The number of standard deviations within which 95 % of normal errors lie.
const OF_95: f64 = 1.96;

/// The position to the east, north and up of a point over time (m), with the 95 % bounds by the standard deviations
/// that the filter reports.
pub fn components(figure: Figure, followed: &Followed, about: &Vector3<f64>) -> Figure {
    let places = followed.enu_from(about);
    // The initial positions are metres off: the scale is chosen for those that follow.
    let after = followed.fixes.first().map(|fix| fix.t + 1800.0);
    let late = followed.fixes.iter().zip(&places).filter(|(fix, _)| Some(fix.t) > after);
    let most = late.flat_map(|(_, place)| place).fold(0.05_f64, |most, it| most.max(it.abs()));
    let line = |axis: usize, name: String, sigmas: f64| {
        let values = places.iter().zip(&followed.deviations);
        let values = values.map(|(place, sigma)| place[axis] + sigmas * sigma[axis]);
        Series::line(name, hours(followed), values.collect()).coloured(Colour::Other(axis))
    };
    let bounds = AXES.iter().enumerate().flat_map(|(axis, name)| {
        [("+", OF_95), ("−", -OF_95)].map(|(sign, sigmas)| Series {
            faint: true,
            ..line(axis, format!("{name} {sign} 95 %"), sigmas)
        })
    });
    let lines = AXES.iter().enumerate().map(|(axis, name)| line(axis, (*name).to_owned(), 0.0));
    figure
        .over_hours("position, m")
        .showing(None, Some([-1.1 * most, 1.1 * most]))
        .with_all(lines)
        .with_all(bounds)
}

/// The standard deviations that the filter reports over time, and the error if the truth is known.
pub fn deviations(figure: Figure, followed: &Followed, truth: Option<&Vector3<f64>>) -> Figure {
    let along = |axis: usize| followed.deviations.iter().map(|it| it[axis]).collect();
    let figure = figure.over_hours("standard deviation, m").logarithmic().with_all(
        AXES.into_iter().enumerate().map(|(axis, name)| {
            Series::line(name, hours(followed), along(axis)).coloured(Colour::Other(axis))
        }),
    );
    let Some(truth) = truth else { return figure };
    let errors = followed.fixes.iter().map(|fix| (fix.position - truth).norm()).collect();
    figure.with(
        Series::new("3-D error", Mark::Dashes, hours(followed), errors).coloured(Colour::Truth),
    )
}
