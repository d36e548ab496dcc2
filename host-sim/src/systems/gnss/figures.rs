//! Figures of what filters made of a recording.

pub mod streams;

use std::collections::BTreeMap;

use kestirim_gnss_files::satellite_name;
use kestirim_ppp_filter::{SatelliteReport, Slipped};
use kestirim_replay::gnss::{BEGINNING, FilterKind, Followed};
use kestirim_robust_kalman::{Decision, Reason};
use nalgebra::Vector3;

use super::track::Track;
use crate::figure::{Colour, Figure, Mark, Series};
use crate::metrics::median;

/// Residuals beyond this are all drawn, in standard deviations; …
pub const FAR: f64 = 4.0;
/// … of the others about so many: in a drawing, …
const DRAWN_NEAR: usize = 600;
/// … and where one can look closer.
const SHOWN_NEAR: usize = 8_000;
/// A satellite has not set as long as it is missing for no more than so many epochs.
const GAP_EPOCHS: f64 = 10.5;

/// Code or phase of a satellite.
pub type Kind = fn(&SatelliteReport) -> &Decision<f64>;

/// The page's figures: all filters of a track in the first, the one that is shown closely in the others.
pub(super) fn draw(track: &Track, truth: Option<&Vector3<f64>>) -> Vec<Figure> {
    let (main, about) = (track.main(), &track.about(truth));
    let origin = if truth.is_some() { "the truth" } else { "the last position" };
    let of = match &*track.filters {
        [_] => "",
        _ => " Of the default filter.",
    };
    let caption = |text: &str| format!("{text}{of}");
    let filters = track.filters.iter().map(|(filter, followed)| (*filter, followed));
    let close = "Over √(Qᵥ/γ), a colour a satellite; the legend shows the rejected ones.";
    vec![
        errors(Figure::new("error", "Distance"), filters, about)
            .with_all(track.smoothed.as_ref().map(|it| error("smoothed", it, about)))
            .caption(format!("Distance from {origin}.")),
        components(Figure::new("components", "East, north, up"), main, about)
            .caption(caption(&format!("To the east, north and up of {origin}."))),
        residuals(Figure::new("residuals", "Residuals of the codes"), main, |it| &it.code)
            .caption(caption(close)),
        residuals(Figure::new("phases", "Residuals of the phases"), main, |it| &it.phase)
            .caption(caption(close)),
        deviations(Figure::new("sigma", "Standard deviations as reported"), main, truth).caption(
            caption(
                "What the filter says of itself, and how far off it is where the truth is known.",
            ),
        ),
        satellites(Figure::new("satellites", "Satellites"), main).caption(caption(
            "When each was used, what of it was rejected, and where its ambiguity began anew.",
        )),
        plan(Figure::new("plan", "Plan"), main, about)
            .caption(caption(&format!("About {origin}; the legend shows the first hour."))),
    ]
}

/// In which colour a filter is drawn.
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

/// Three-dimensional errors of filters over the hours.
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

/// The distance from a place over the hours, m.
fn error(name: impl Into<String>, followed: &Followed, place: &Vector3<f64>) -> Series {
    let errors = followed.fixes.iter().map(|fix| (fix.position - place).norm());
    Series::line(name, hours(followed), errors.collect())
}

/// The position to the east, north and up of a place over the hours, m.
pub fn components(figure: Figure, followed: &Followed, about: &Vector3<f64>) -> Figure {
    let places = followed.enu_from(about);
    let along = |axis: usize| places.iter().map(|place| place[axis]).collect();
    // The beginning is metres off: what comes after it is to be seen.
    let after = followed.fixes.first().map(|fix| fix.t + 1800.0);
    let late = followed.fixes.iter().zip(&places).filter(|(fix, _)| Some(fix.t) > after);
    let most = late.flat_map(|(_, place)| place).fold(0.05_f64, |most, it| most.max(it.abs()));
    figure.over_hours("position, m").showing(None, Some([-1.1 * most, 1.1 * most])).with_all(
        ["east", "north", "up"].into_iter().enumerate().map(|(axis, name)| {
            Series::line(name, hours(followed), along(axis)).coloured(Colour::Other(axis))
        }),
    )
}

/// The standard deviations that the filter reports over the hours, and the error where the truth is known.
pub fn deviations(figure: Figure, followed: &Followed, truth: Option<&Vector3<f64>>) -> Figure {
    let along = |axis: usize| followed.deviations.iter().map(|it| it[axis]).collect();
    let figure = figure.over_hours("standard deviation, m").logarithmic().with_all(
        ["east", "north", "up"].into_iter().enumerate().map(|(axis, name)| {
            Series::line(name, hours(followed), along(axis)).coloured(Colour::Other(axis))
        }),
    );
    let Some(truth) = truth else { return figure };
    let errors = followed.fixes.iter().map(|fix| (fix.position - truth).norm()).collect();
    figure.with(
        Series::new("3-D error", Mark::Dashes, hours(followed), errors).coloured(Colour::Truth),
    )
}

/// The residual of an observation over its deviation √(Qᵥ/γ); none if it was rejected.
pub fn standardised(decision: &Decision<f64>) -> Option<f64> {
    let weighted = decision.standardised * decision.weight.sqrt();
    (decision.reason != Reason::Rejected).then_some(weighted)
}

/// What is left in the observations in use over the hours, and that which is far off.
pub fn left(figure: Figure, followed: &Followed, kind: Kind) -> Figure {
    let used = followed.residuals.iter();
    let used = used.filter_map(|(t, report)| Some([t / 3600.0, standardised(kind(report))?]));
    let (far, near): (Vec<_>, Vec<_>) = used.partition(|[_, value]| value.abs() > FAR);
    let step = near.len().div_ceil(DRAWN_NEAR).max(1);
    let near = near.into_iter().step_by(step);
    figure.over_hours("residual, σ").with(Series::points("in use", near).marked(Mark::Dots)).with(
        Series::points(format!("in use, beyond {FAR} σ"), far)
            .marked(Mark::Dots)
            .coloured(Colour::Alarm),
    )
}

/// Residuals of each satellite over the hours, and those for which observations were rejected.
pub fn residuals(figure: Figure, followed: &Followed, kind: Kind) -> Figure {
    let step = followed.residuals.len().div_ceil(SHOWN_NEAR).max(1);
    let mut used: BTreeMap<u8, Vec<[f64; 2]>> = BTreeMap::new();
    let mut rejected = Vec::new();
    for (place, (t, report)) in followed.residuals.iter().enumerate() {
        let (decision, t) = (kind(report), t / 3600.0);
        match standardised(decision) {
            Some(value) if value.abs() > FAR || place % step == 0 => {
                used.entry(report.satellite).or_default().push([t, value]);
            }
            Some(_) => {}
            None => rejected.push([t, decision.standardised]),
        }
    }
    let satellites = used.into_iter().enumerate().map(|(place, (satellite, points))| {
        Series::points(satellite_name(satellite), points)
            .marked(Mark::Dots)
            .coloured(Colour::Other(place))
    });
    figure.over_hours("residual, σ").with_all(satellites).with(
        Series::points("rejected", rejected).marked(Mark::Crosses).coloured(Colour::Alarm).hidden(),
    )
}

/// Which satellites were used when, what of them was rejected, and where their ambiguities began anew.
pub fn satellites(figure: Figure, followed: &Followed) -> Figure {
    let steps: Vec<_> = followed.fixes.windows(2).map(|pair| pair[1].t - pair[0].t).collect();
    let longest = GAP_EPOCHS * median(&steps);
    let mut arcs: BTreeMap<u8, Vec<[f64; 2]>> = BTreeMap::new();
    let (mut codes, mut phases, mut slips) = (Vec::new(), Vec::new(), Vec::new());
    for (t, report) in &followed.residuals {
        let arcs = arcs.entry(report.satellite).or_default();
        match arcs.last_mut() {
            Some([_, last]) if t - *last <= longest => *last = *t,
            _ => arcs.push([*t; 2]),
        }
        let point = [t / 3600.0, f64::from(report.satellite)];
        let is_rejected = |decision: &Decision<f64>| decision.reason == Reason::Rejected;
        codes.extend(is_rejected(&report.code).then_some(point));
        phases.extend(is_rejected(&report.phase).then_some(point));
        let slipped = !matches!(report.slipped, None | Some(Slipped::New));
        slips.extend(slipped.then_some(point));
    }
    let used = arcs.into_iter().flat_map(|(satellite, arcs)| {
        arcs.into_iter().flat_map(move |[first, last]| {
            let at = |t: f64| [t / 3600.0, f64::from(satellite)];
            [at(first), at(last), [f64::NAN; 2]]
        })
    });
    figure
        .over_hours("satellite (PRN)")
        .with(Series::path("used", used).coloured(Colour::Truth))
        .with(Series::points("code rejected", codes).marked(Mark::Dots).coloured(Colour::Other(1)))
        .with(Series::points("phase rejected", phases).marked(Mark::Dots).coloured(Colour::Alarm))
        .with(Series::points("ambiguity anew", slips).coloured(Colour::Other(3)))
}

/// Where the positions are on the ground, about a place.
pub fn plan(figure: Figure, followed: &Followed, about: &Vector3<f64>) -> Figure {
    let begin = followed.fixes.first().map_or(0.0, |fix| fix.t);
    let places = followed.fixes.iter().zip(followed.enu_from(about));
    let places = places.map(|(fix, [e, n, _])| (fix.t, [e, n]));
    let (early, late): (Vec<_>, Vec<_>) = places.partition(|(t, _)| *t < begin + BEGINNING);
    // A short recording has nothing else to show.
    let hide = |series: Series| if late.is_empty() { series } else { series.hidden() };
    let dots = |name: &str, places: &[(f64, [f64; 2])]| {
        let dots = Series::points(name, places.iter().map(|(_, place)| *place)).marked(Mark::Dots);
        dots.timed(places.iter().map(|(t, _)| *t))
    };
    let early = hide(dots("first hour", &early).coloured(Colour::Other(1)));
    figure
        .axes("east, m", "north, m")
        .map()
        .with(early)
        .with(dots("after it", &late))
        .with(Series::points("origin", [[0.0, 0.0]]).coloured(Colour::Truth))
}

fn hours(followed: &Followed) -> Vec<f64> {
    followed.fixes.iter().map(|fix| fix.t / 3600.0).collect()
}
