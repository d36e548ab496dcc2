//! The results of a walk.

pub mod accuracy;

use kestirim_replay::pedestrian::{TrackPoint, Walk};
use serde::Serialize;

use self::accuracy::Accuracy;
use super::Pedestrian;
use super::recording::Recording;
use crate::Error;
use crate::system::{Account, System, Table};

/// The report that a replay prints.
#[derive(Debug, Clone, Serialize)]
struct Report {
    system: &'static str,
    samples: usize,
    duration_s: f64,
    sensor: String,
    path_length_m: f64,
    closure_m: f64,
    heading_rate_deg_per_min: Option<f64>,
    heading_rate_sigma_deg_per_min: Option<f64>,
    other_foot_meetings: Option<usize>,
    other_foot_apart_m: Option<f64>,
    right_angles_share: Option<f64>,
    gap_m: Option<f64>,
    strides: Vec<StrideReport>,
    import: Vec<String>,
    warnings: Vec<String>,
    accuracy: Option<Accuracy>,
}

#[derive(Debug, Clone, Serialize)]
struct StrideReport {
    t: f64,
    x: f64,
    y: f64,
    z: f64,
    length_m: f64,
    sx: f64,
    sy: f64,
    sz: f64,
}

/// Evaluates a walk.
pub(super) fn account(recording: &Recording, walk: &Walk) -> Result<Account, Error> {
    let log = &recording.log;
    let strides = walk.strides.iter().map(|stride| {
        let [x, y, z] = stride.position;
        let [sx, sy, sz] = stride.sigma_m;
        let t = stride.time_us as f64 / 1e6;
        StrideReport { t, x, y, z, length_m: stride.length_m, sx, sy, sz }
    });
    let accuracy = Accuracy::of(recording, walk);
    let report = Report {
        system: Pedestrian::NAME,
        samples: log.samples.len(),
        duration_s: log.duration_s(),
        sensor: format!("{:?}", walk.sensor).to_lowercase(),
        path_length_m: walk.path_length_m,
        closure_m: walk.closure_m,
        heading_rate_deg_per_min: walk.heading_rate.map(degrees_per_minute),
        // Closing the path changes the heading rate once more.
        heading_rate_sigma_deg_per_min: (walk.right_angles.map(|angles| angles.rate_sigma))
            .or(walk.both_feet.map(|feet| feet.rate_sigma))
            .filter(|_| walk.gap_m.is_none())
            .map(degrees_per_minute),
        other_foot_meetings: walk.both_feet.map(|feet| feet.meetings),
        other_foot_apart_m: walk.both_feet.map(|feet| feet.distance_m),
        right_angles_share: walk.right_angles.map(|angles| angles.share),
        gap_m: walk.gap_m,
        strides: strides.collect(),
        import: log.import.clone(),
        warnings: log.warnings.iter().chain(&walk.warnings).cloned().collect(),
        accuracy,
    };
    let mut account = Account::new(&report, report.warnings.clone())?;
    account.about = Some(recording.path.clone());
    account.understood(&report.import);
    walk.doubts.reasons().for_each(|reason| account.doubt(reason));
    account.fact("samples", format!("{} in {:.1} s", report.samples, report.duration_s));
    account.fact("class of the sensor", report.sensor.clone());
    account.fact("strides", report.strides.len().to_string());
    account.fact("path length", format!("{:.2} m", report.path_length_m));
    account.fact("start to end", format!("{:.2} m", report.closure_m));
    if let Some(feet) = walk.both_feet {
        let (count, apart_m) = (feet.meetings, feet.distance_m);
        account.fact("meetings with the other sensor", format!("{count}, {apart_m:.2} m apart"));
    }
    if let Some(share) = report.right_angles_share {
        account.fact("along right angles", format!("{:.0} % of the path", 100.0 * share));
    }
    if let Some(gap_m) = report.gap_m {
        account.fact("start to end, before it was closed", format!("{gap_m:.2} m"));
    }
    if let Some(rate) = report.heading_rate_deg_per_min {
        let is_from_the_path =
            walk.gap_m.is_some() || walk.right_angles.is_some() || walk.both_feet.is_some();
        let from = if is_from_the_path { "taken back" } else { "from the magnetometer" };
        let sigma = report.heading_rate_sigma_deg_per_min;
        let spread = sigma.map(|sigma| format!(" ± {sigma:.2}")).unwrap_or_default();
        account.fact(format!("drift of the heading, {from}"), format!("{rate:+.2}{spread} °/min"));
    }
    if let Some([x, y, z]) = walk.strides.last().map(|stride| stride.sigma_m) {
        account.fact("standard deviations of the end", format!("{x:.2}, {y:.2}, {z:.2} m"));
    }
    for (name, value) in accuracy.iter().flat_map(Accuracy::in_words) {
        account.fact(name, value);
    }
    Ok(account)
}

/// Converts rad/s to °/min.
fn degrees_per_minute(rate: f64) -> f64 {
    60.0 * rate.to_degrees()
}

/// The table of time, position and its standard deviations at every sample.
pub(super) fn table(walk: &Walk) -> Table {
    let row = |(point, sigma_m): (&TrackPoint, [f64; 3])| {
        let time = format!("{}.{:06}", point.time_us / 1_000_000, point.time_us % 1_000_000);
        let position = point.position.map(|metres| format!("{metres:.6}"));
        let sigma = sigma_m.map(|metres| format!("{metres:.4}"));
        std::iter::once(time).chain(position).chain(sigma).collect()
    };
    let sigmas_m = walk.sigmas_m(walk.track.iter().map(|point| point.time_us));
    Table {
        rows: walk.track.iter().zip(sigmas_m).map(row).collect(),
        health: walk.healths().collect(),
        ..Table::new(&["t", "x", "y", "z", "sx", "sy", "sz"])
    }
}
