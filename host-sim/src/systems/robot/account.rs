//! The results of a recording.

pub mod accuracy;

use std::collections::BTreeSet;

use kestirim_replay::robot::{Dimensions, Event, Setup, Smoothed, Trace, doubts, mirrored};
use serde::Serialize;

use self::accuracy::Accuracy;
use super::links::Link;
use super::recording::Recording;
use super::track::Tracks;
use super::{Robot, height, settings};
use crate::Error;
use crate::system::{Account, Settings, System, Table};
use crate::text::printable;

/// The report that a replay prints.
#[derive(Debug, Clone, Serialize)]
struct Report {
    system: &'static str,
    updates: usize,
    rejected: usize,
    lost_s: f64,
    links: Vec<Link>,
    import: Vec<String>,
    warnings: Vec<String>,
    accuracy: Option<Accuracy>,
    #[serde(skip_serializing_if = "Option::is_none")]
    smoothed: Option<SmoothedReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    height: Option<HeightReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    points: Option<Vec<PointReport>>,
}

/// The height of the tag as determined from its ranges (m), and its contribution to the standard deviation of the
/// position.
#[derive(Debug, Clone, Serialize)]
struct HeightReport {
    metres: f64,
    sigma_m: f64,
    position_sigma_m: f64,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    biases_m: Vec<f64>,
}

/// The results of the smoother, including what it determined about the anchors.
#[derive(Debug, Clone, Serialize)]
struct SmoothedReport {
    accuracy: Option<Accuracy>,
    /// The common bias of all anchors (m), in addition to what was known beforehand.
    common_bias_m: f64,
    common_bias_sigma_m: f64,
    /// The further excess of the ranges per 10 m of distance (m).
    excess_in_10_m: f64,
    excess_in_10_m_sigma: f64,
    anchors: Vec<AnchorReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    points: Option<Vec<PointReport>>,
}

/// The bias of an anchor (m), in addition to that of all of them.
#[derive(Debug, Clone, Serialize)]
struct AnchorReport {
    anchor: String,
    bias_m: f64,
    sigma_m: f64,
}

/// The estimated position of the tag at a marked point (m).
#[derive(Debug, Clone, Serialize)]
struct PointReport {
    point: String,
    x: f64,
    y: f64,
    z: f64,
}

/// Evaluates a recording.
pub(super) fn account(
    recording: &Recording,
    settings: &Settings,
    tracks: &Tracks,
) -> Result<Account, Error> {
    let traces = tracks.traces.as_slice();
    let points = points(recording, traces.iter().map(Trace::last));
    let setup = settings::of_recording(recording, settings)?;
    let found = &setup.found;
    let report = Report {
        system: Robot::NAME,
        updates: traces.iter().map(Trace::taken).sum(),
        rejected: traces.iter().map(Trace::rejected).sum(),
        lost_s: traces.iter().map(Trace::lost_s).sum(),
        links: Link::all(recording, &setup, traces),
        import: recording.import.clone(),
        warnings: warnings(recording, tracks, points.as_deref(), &setup),
        accuracy: Accuracy::of_recording(recording, traces),
        smoothed: tracks.smoothed().map(|smoothed| of_smoothed(recording, smoothed)),
        height: found.as_ref().map(|found| HeightReport {
            metres: found.metres,
            sigma_m: found.sigma_m,
            position_sigma_m: found.position_sigma_m,
            biases_m: found.biases.clone(),
        }),
        points,
    };
    let mut account = Account::new(&report, report.warnings.clone())?;
    account.about.clone_from(&recording.path);
    account.understood(&report.import);
    for reason in doubts(traces, recording.is_static()).reasons() {
        account.doubt(reason);
    }
    account.fact("ranges taken in", report.updates.to_string());
    account.fact("ranges left out", report.rejected.to_string());
    if let Some(worst) = worst(&report.links) {
        account.fact("most left out", worst);
    }
    account.fact("without a position", format!("{:.1} s", report.lost_s));
    if let Some(last) = last_position(recording, traces) {
        account.fact("last position", last);
    }
    if let Some(found) = found {
        account.fact("height of the tag", height::in_words(found));
    }
    if let Some(points) = &report.points {
        account.fact("points found", points.len().to_string());
    }
    for (name, value) in report.accuracy.iter().flat_map(Accuracy::in_words) {
        account.fact(name, value);
    }
    if let Some(smoothed) = &report.smoothed {
        for (name, value) in smoothed.accuracy.iter().flat_map(Accuracy::in_words) {
            account.fact(format!("{name}, smoothed"), value);
        }
        let biases = smoothed.anchors.iter().map(|it| (&it.anchor, it.bias_m, it.sigma_m));
        for (anchor, bias_m, sigma_m) in biases {
            let bias = [smoothed.common_bias_m + bias_m, sigma_m].map(|metres| 100.0 * metres);
            account.fact(
                format!("anchor {anchor} too long, smoothed"),
                format!("{:.0} ± {:.0} cm", bias[0], bias[1]),
            );
        }
    }
    Ok(account)
}

/// The position of a moving tag at the end of its log, with its standard deviations (m), as text.
fn last_position(recording: &Recording, traces: &[Trace]) -> Option<String> {
    let last = traces.last().filter(|_| !recording.is_static())?.epochs.last()?;
    let Some(position) = last.position else { return Some("not known".to_owned()) };
    let axes = ["x", "y", "z"].into_iter().zip(position).zip(last.sigmas_m());
    let told = axes.map(|((axis, metres), sigma)| match sigma {
        Some(sigma) => format!("{axis} {metres:.2} ± {sigma:.2} m"),
        None => format!("{axis} {metres:.2} m"),
    });
    Some(told.collect::<Vec<_>>().join(", "))
}

/// The anchor with the largest share of rejected ranges, if any were rejected.
fn worst(links: &[Link]) -> Option<String> {
    let shares = links.iter().filter_map(|link| Some((link, link.rejected_share?)));
    let (link, share) =
        shares.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, share)| *share > 0.0)?;
    Some(format!("{}: {:.1} % of {}", printable(&link.anchor), 100.0 * share, link.ranges))
}

/// The estimated positions at the points; `None` for a moving tag.
fn points(
    recording: &Recording,
    last: impl Iterator<Item = Option<[f64; 3]>>,
) -> Option<Vec<PointReport>> {
    let found = recording.parts.iter().zip(last).filter_map(|(part, position)| {
        let [x, y, z] = position?;
        Some(PointReport { point: part.name.clone(), x, y, z })
    });
    recording.is_static().then(|| found.collect())
}

fn of_smoothed(recording: &Recording, smoothed: &Smoothed) -> SmoothedReport {
    let parts = || smoothed.parts.iter().map(Vec::as_slice);
    let last = parts().map(|epochs| epochs.last().and_then(|epoch| epoch.position));
    let anchors = recording.anchors.names.iter().zip(&smoothed.biases);
    let [[common_bias_m, common_bias_sigma_m], [excess_in_10_m, excess_in_10_m_sigma]] =
        smoothed.common;
    SmoothedReport {
        accuracy: Accuracy::of_parts(recording, parts()),
        points: points(recording, last),
        common_bias_m,
        common_bias_sigma_m,
        excess_in_10_m,
        excess_in_10_m_sigma,
        anchors: anchors
            .map(|(anchor, &[bias_m, sigma_m])| AnchorReport {
                anchor: anchor.clone(),
                bias_m,
                sigma_m,
            })
            .collect(),
    }
}

/// The reason why there is no position.
fn nowhere(recording: &Recording, dimensions: Dimensions) -> String {
    let heard = |event: &Event| match event {
        Event::Range(range) => vec![range.anchor],
        Event::Difference(difference) => difference.anchors.to_vec(),
        _ => Vec::new(),
    };
    let heard: BTreeSet<usize> =
        recording.parts.iter().flat_map(|part| &part.events).flat_map(heard).collect();
    let (needed, height) = match dimensions {
        Dimensions::Two => (3, ", and --height"),
        Dimensions::Three => (4, ""),
    };
    let heard = heard.len();
    if heard < needed {
        return format!(
            "no position was found: it takes ranges to {needed} anchors, and {heard} are heard"
        );
    }
    format!(
        "no position was found: at no time do {needed} anchors agree on a place; look at the unit, the anchors' places and names{height}"
    )
}

fn warnings(
    recording: &Recording,
    tracks: &Tracks,
    points: Option<&[PointReport]>,
    setup: &Setup,
) -> Vec<String> {
    let traces = &tracks.traces;
    let mut warnings = recording.warnings.clone();
    if let Some(Err(reason)) = tracks.smoothed {
        warnings.push(format!("not smoothed: {reason}"));
    }
    match points.map(|points| recording.parts.len() - points.len()) {
        Some(0) => {}
        Some(missing) => {
            warnings.push(format!("points without ranges enough for a position: {missing}"));
        }
        None if traces.iter().all(|trace| trace.known().next().is_none()) => {
            warnings.push(nowhere(recording, setup.dimensions));
        }
        None => {}
    }
    if let Some(share) = mirrored(traces, recording.is_static()) {
        // A room is a rectangle in the plane.
        let hint = match (setup.dimensions, setup.room.is_some()) {
            (Dimensions::Three, _) => ": --dim 2 with --height may tell which",
            (Dimensions::Two, false) => ": --room may tell which",
            (Dimensions::Two, true) => "",
        };
        warnings.push(format!(
            "at {:.0} % of the positions the ranges allow two places, one on either side of the only anchors heard{hint}",
            100.0 * share
        ));
    }
    warnings
}

/// The table of position and standard deviations, as far as they are known, at every epoch or at every point.
pub(super) fn table(recording: &Recording, tracks: &Tracks) -> Table {
    let first = if recording.is_static() { "point" } else { "t" };
    let mut table = Table::new(&[first, "x", "y", "z", "sx", "sy", "sz"]);
    for (part, epochs) in recording.parts.iter().zip(tracks.best()) {
        let last = recording.is_static().then(|| epochs.len().saturating_sub(1));
        for epoch in &epochs[last.unwrap_or_default()..] {
            let Some(position) = epoch.position else { continue };
            let label =
                if recording.is_static() { part.name.clone() } else { seconds(epoch.time_us) };
            let sigma =
                |metres: Option<f64>| metres.map_or_else(String::new, |it| format!("{it:.4}"));
            let numbers = position.map(|metres| format!("{metres:.6}")).into_iter();
            let fields = numbers.chain(epoch.sigmas_m().map(sigma));
            table.rows.push(std::iter::once(label).chain(fields).collect());
            table.health.push(epoch.health.state());
        }
    }
    table
}

fn seconds(time_us: i64) -> String {
    let sign = if time_us < 0 { "-" } else { "" };
    let size = time_us.unsigned_abs();
    format!("{sign}{}.{:06}", size / 1_000_000, size % 1_000_000)
}
