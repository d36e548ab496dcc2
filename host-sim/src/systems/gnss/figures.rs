//! Figures of the filters' results.

pub mod arcs;
pub mod dilution;
pub mod plan;
pub mod position;
pub mod residuals;
pub mod satellites;
pub mod sheet;
pub mod sky;
pub mod streams;

use kestirim_ppp_filter::Config;
use kestirim_replay::gnss::{FilterKind, Followed, Recording};
use nalgebra::Vector3;

use self::arcs::Arcs;
use self::dilution::dilution;
use self::plan::plan;
use self::position::{components, deviations};
use self::residuals::{Shown, over_elevation, residuals};
use self::satellites::satellites;
use self::sheet::sheet;
use self::sky::sky;
use super::settings::Setup;
use super::track::Track;
use crate::figure::{Colour, Figure, Series};
use crate::system::Answer;

/// Adds the page's figures and tables: the first figure shows all filters of a track, the others the one that is shown
/// in detail.
pub(super) fn draw(recording: &Recording, setup: &Setup, track: &Track, answer: &mut Answer) {
    let truth = setup.truth(recording);
    let (main, about) = (track.main(), &track.about(truth.as_ref()));
    let arcs = Arcs::of(main);
    let origin = if truth.is_some() { "the truth" } else { "the last position" };
    let filters = track.filters.iter().map(|(filter, followed)| (*filter, followed));
    let distance = errors(Figure::new("error", "Distance"), filters, about)
        .with_all(track.smoothed.as_ref().map(|it| error("smoothed", it, about)))
        .caption(format!("Distance from {origin}."));
    let sigma = Figure::new("sigma", "Standard deviations as reported");
    let sigma = deviations(sigma, main, truth.as_ref())
        .caption("What the filter says of itself, and how far off it is where the truth is known.");
    let closely = [sigma].into_iter().chain(of_places(main, &arcs, (origin, about)));
    let closely = closely.chain(of_satellites(main, &arcs, &setup.config(setup.main())));
    answer.tables = vec![sheet(&arcs)];
    answer.figures = vec![distance];
    answer.figures.extend(closely);
    if track.filters.len() > 1 {
        let figures = answer.figures.iter_mut().skip(1).map(|it| &mut it.caption);
        let tables = answer.tables.iter_mut().map(|it| &mut it.caption);
        figures.chain(tables).for_each(|caption| caption.push_str(" Of the default filter."));
    }
    let zero = recording.utc(0.0);
    for figure in answer.figures.iter_mut().filter(|figure| figure.x.seconds.is_some()) {
        figure.x.label = format!("time, h since {zero}");
    }
}

/// Figures of positions relative to a point named `origin`.
fn of_places(
    followed: &Followed,
    arcs: &Arcs<'_>,
    (origin, about): (&str, &Vector3<f64>),
) -> [Figure; 2] {
    let [parts, ground] = [("components", "East, north, up"), ("plan", "Plan")]
        .map(|(id, title)| Figure::new(id, title));
    [
        components(parts, followed, about).caption(format!(
            "To the east, north and up of {origin}; faint is where 95 of 100 would be by the filter's own deviations."
        )),
        plan(ground, followed, arcs, (origin, about)).caption(format!(
            "About {origin}: dots, of which the legend shows the first hour, or the path of a receiver that moves."
        )),
    ]
}

/// Figures of the satellites.
fn of_satellites(followed: &Followed, arcs: &Arcs<'_>, config: &Config) -> [Figure; 7] {
    let code = Shown { kind: |it| &it.code, noise: config.code, unit: ("m", 1.0) };
    let phase = Shown { kind: |it| &it.phase, noise: config.phase, unit: ("mm", 1e-3) };
    let close = "Over √(Qᵥ/γ), a colour a satellite; the legend shows the rejected ones.";
    let slopes = "Those in use. A bad satellite leaves the broken lines high up, multipath near the horizon.";
    let new = Figure::new;
    [
        sky(new("sky", "Sky"), followed, arcs, config.elevation_mask).caption(
            "The zenith is in the middle, north above, east on the right; each satellite has its name where it was last \
             used. Crosses are rejected observations and ambiguities begun anew.",
        ),
        dilution(new("dilution", "Satellites and DOP"), followed, arcs).caption(
            "How many satellites were used, and by how much their directions multiply the error of a range.",
        ),
        satellites(new("satellites", "Satellites"), followed, arcs).caption(
            "When each was observed, what of it was rejected, and where its ambiguity began anew.",
        ),
        residuals(new("residuals", "Residuals of the codes"), followed, code.kind).caption(close),
        residuals(new("phases", "Residuals of the phases"), followed, phase.kind).caption(close),
        over_elevation(new("code-elevation", "Codes against elevation"), arcs, code).caption(slopes),
        over_elevation(new("phase-elevation", "Phases against elevation"), arcs, phase).caption(slopes),
    ]
}

/// The colour of a filter.
pub fn colour(filter: FilterKind) -> Colour {
    match filter {
        FilterKind::Default => Colour::Ours,
        FilterKind::Gkf => Colour::Other(1),
        FilterKind::Rkf => Colour::Other(2),
        FilterKind::Skf => Colour::Other(3),
        FilterKind::Ikf => Colour::Other(4),
        FilterKind::Adaptive => Colour::Other(5),
    }
}

/// The 3-D errors of filters over time, in hours.
pub fn errors<'a>(
    figure: Figure,
    filters: impl IntoIterator<Item = (FilterKind, &'a Followed)>,
    truth: &Vector3<f64>,
) -> Figure {
    let line = |(filter, followed): (FilterKind, &Followed)| {
        error(filter.title(), followed, truth).coloured(colour(filter))
    };
    figure.over_hours("3-D error, m").logarithmic().with_all(filters.into_iter().map(line))
}

/// The distance from a point over time, in hours (m).
fn error(name: impl Into<String>, followed: &Followed, place: &Vector3<f64>) -> Series {
    let errors = followed.fixes.iter().map(|fix| (fix.position - place).norm());
    Series::line(name, hours(followed), errors.collect())
}

fn hours(followed: &Followed) -> Vec<f64> {
    followed.fixes.iter().map(|fix| fix.t / 3600.0).collect()
}
