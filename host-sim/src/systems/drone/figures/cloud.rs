//! Figures of a filter's belief about the position.

use kestirim_replay::drone::{Cloud, Region, Track};

use super::knowledge::Known;
use crate::figure::{Colour, Figure, Mark, Series};

/// The number of moments of a flight at which the cloud is drawn.
const MOMENTS: usize = 6;

/// Draws the light and the heavy particles, the border of the region that holds 90 %, and that of a normal
/// distribution.
pub(in crate::systems::drone) fn on(figure: Figure, cloud: &Cloud) -> Figure {
    let dots = |name: &str, places: &[[f32; 2]], colour| {
        let places = places.iter().map(|place| place.map(f64::from));
        Series::points(name, places).marked(Mark::Dots).coloured(colour)
    };
    figure
        .with(dots("particles with the last tenth of the weight", &cloud.light, Colour::Truth))
        .with(dots("particles", &cloud.heavy, Colour::Other(4)))
        .with(border("90 % region", &cloud.region()).coloured(Colour::Ours))
        .with(Series::path("90 % ellipse", cloud.ellipse()).coloured(Colour::Ours).hidden())
}

/// The cloud at several moments of the flight, from the first estimate to the last.
pub(super) fn at_moments(track: &Track, known: &[Known<'_>]) -> Figure {
    let count = known.len();
    let moments = MOMENTS.min(count);
    // No moment is drawn twice.
    let places = (0..moments).map(|k| k * (count - 1) / moments.saturating_sub(1).max(1));
    let mut figure = Figure::new("clouds", "What was believed on the way")
        .axes("x, m", "y, m")
        .map()
        .caption(
            "A few particles of equal weight, and the border of the smallest region that holds 90 % of the weight.",
        );
    let user = track.estimates.iter().filter_map(|it| Some((track.seconds(it), track.user(it)?)));
    let (times, user): (Vec<_>, Vec<_>) = user.unzip();
    for (moment, place) in places.enumerate() {
        let Some((t, cloud, region)) = known.get(place) else { continue };
        let timed = |series: Series| {
            let times = vec![*t; series.x.len()];
            series.timed(times).coloured(Colour::Other(moment))
        };
        let particles = cloud.sample.iter().map(|place| place.map(f64::from));
        let particles = Series::points(format!("at {t:.0} s"), particles).marked(Mark::Dots);
        let region = border(&format!("90 % region at {t:.0} s"), region);
        figure = figure.with(timed(particles)).with(timed(region));
    }
    figure.with(Series::path("user", user).timed(times).coloured(Colour::Truth))
}

/// A border of short separate line segments.
fn border(name: &str, region: &Region) -> Series {
    let gap = [f64::NAN; 2];
    Series::path(name, region.border.iter().flat_map(|&[from, to]| [from, to, gap]))
}
