//! Figures of residuals.

use std::collections::BTreeMap;

use kestirim_gnss_files::satellite_name;
use kestirim_ppp_filter::{Deviation, SatelliteReport};
use kestirim_replay::gnss::Followed;
use kestirim_robust_kalman::Decision;

use super::arcs::{Arcs, is_rejected};
use crate::figure::{Colour, Figure, Mark, Series};

/// The residual, in standard deviations, beyond which all are drawn.
pub const FAR: f64 = 4.0;
/// The approximate number of smaller residuals in a static drawing.
const DRAWN_NEAR: usize = 600;
/// The approximate number of smaller residuals in a figure that can be zoomed.
const SHOWN_NEAR: usize = 8_000;
/// The approximate number of smaller residuals over the elevation: each also has its time, so that fewer are as
/// informative.
const NEAR_OVER_ELEVATION: usize = 4_000;

/// A selector of a satellite's code or phase.
pub type Kind = fn(&SatelliteReport) -> &Decision<f64>;

/// The residual of an observation divided by its deviation √(Qᵥ/γ); `None` if it was rejected.
pub fn standardised(decision: &Decision<f64>) -> Option<f64> {
    let weighted = decision.standardised * decision.weight.sqrt();
    (!is_rejected(decision)).then_some(weighted)
}

/// The residuals of the observations in use over time, with the outlying ones marked.
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

/// The residuals of each satellite over time, and those of rejected observations.
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

/// A kind of observation as shown over the elevation.
#[derive(Debug, Clone, Copy)]
pub struct Shown {
    /// The selector of code or phase.
    pub kind: Kind,
    /// The noise that the filter assumes.
    pub noise: Deviation,
    /// The unit shown, and its length in metres.
    pub unit: (&'static str, f64),
}

/// The residuals of each satellite in use over its elevation, and three standard deviations of the noise that the
/// filter assumes.
pub fn over_elevation(figure: Figure, arcs: &Arcs<'_>, shown: Shown) -> Figure {
    let Shown { kind, noise, unit: (unit, metres) } = shown;
    let count: usize = arcs.satellites().map(|(_, sightings)| sightings.len()).sum();
    let step = count.div_ceil(NEAR_OVER_ELEVATION).max(1);
    let satellites = arcs.satellites().enumerate().map(|(place, (number, sightings))| {
        let (mut times, mut points) = (Vec::new(), Vec::new());
        for arc in arcs.split(sightings) {
            for (index, (t, report)) in arc.iter().enumerate() {
                let decision = kind(report);
                let is_far = standardised(decision).is_some_and(|value| value.abs() > FAR);
                if !is_rejected(decision) && (is_far || index % step == 0) {
                    times.push(*t);
                    let elevation = report.direction.elevation.to_degrees();
                    points.push([elevation, decision.residual / metres]);
                }
            }
            // Nothing is shown after a satellite has set.
            times.extend(arc.last().map(|(t, _)| *t));
            points.extend(arc.last().map(|_| [f64::NAN; 2]));
        }
        Series::points(satellite_name(number), points)
            .timed(times)
            .marked(Mark::Dots)
            .coloured(Colour::Other(place))
    });
    let bound = |side: f64| {
        (0..=90).map(move |degrees| {
            let slant = noise.slant * f64::from(degrees).to_radians().cos();
            [f64::from(degrees), side * 3.0 * noise.zenith.hypot(slant) / metres]
        })
    };
    let bounds = bound(1.0).chain([[f64::NAN; 2]]).chain(bound(-1.0));
    figure
        .axes("elevation, °", format!("residual, {unit}"))
        .with_all(satellites)
        .with(Series::path("±3 σ as assumed", bounds).marked(Mark::Dashes).coloured(Colour::Limit))
}
