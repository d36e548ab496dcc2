//! The streams of a filter's results, for other programs.

use std::collections::BTreeSet;

use kestirim_gnss_files::satellite_name;
use kestirim_ppp_filter::SatelliteReport;
use kestirim_replay::gnss::Followed;
use kestirim_robust_kalman::Reason;
use nalgebra::Vector3;

use crate::stream::Stream;

const ESTIMATE: [&str; 9] =
    ["x_m", "y_m", "z_m", "sd_x_m", "sd_y_m", "sd_z_m", "ecef_x_m", "ecef_y_m", "ecef_z_m"];

/// The streams: positions to the east (x), north (y) and up (z) of `about` (ECEF, m), which is the truth if `is_truth`;
/// and the satellites' results if their residuals were kept.
pub fn streams(followed: &Followed, about: &Vector3<f64>, is_truth: bool) -> Vec<Stream> {
    let places = followed.fixes.iter().zip(followed.enu_from(about)).zip(&followed.deviations);
    let estimate = places.map(|((fix, place), deviations)| {
        (fix.t, [place, *deviations, fix.position.into()].concat())
    });
    let mut streams = vec![Stream::new("/gnss/estimate", &ESTIMATE, estimate.collect())];
    if is_truth {
        let truth = followed.fixes.iter().map(|fix| (fix.t, vec![0.0; 3])).collect();
        streams.push(Stream::new("/gnss/truth", &["x_m", "y_m", "z_m"], truth));
    }
    if !followed.residuals.is_empty() {
        streams.push(counts(&followed.residuals));
        let code = |report: &SatelliteReport| report.code.residual;
        streams.push(by_satellite("/gnss/code_residuals", &followed.residuals, code));
        let phase = |report: &SatelliteReport| report.phase.residual;
        streams.push(by_satellite("/gnss/phase_residuals", &followed.residuals, phase));
    }
    streams
}

/// The numbers of satellites used and of rejected observations.
fn counts(residuals: &[(f64, SatelliteReport)]) -> Stream {
    let row = |reports: &[(f64, SatelliteReport)]| {
        let count = |of: fn(&SatelliteReport) -> bool| {
            reports.iter().filter(|(_, report)| of(report)).count() as f64
        };
        let counts = [
            count(|_| true),
            count(|report| report.code.reason == Reason::Rejected),
            count(|report| report.phase.reason == Reason::Rejected),
            count(|report| report.slipped.is_some()),
        ];
        (reports[0].0, counts.to_vec())
    };
    let columns = ["used", "codes_rejected", "phases_rejected", "ambiguities_anew"];
    Stream::new("/gnss/satellites", &columns, epochs(residuals).map(row).collect())
}

/// A stream with a column per satellite that has reports.
fn by_satellite(
    topic: &str,
    residuals: &[(f64, SatelliteReport)],
    of: fn(&SatelliteReport) -> f64,
) -> Stream {
    let satellites: BTreeSet<u8> = residuals.iter().map(|(_, report)| report.satellite).collect();
    let name = |satellite: &u8| format!("{}_m", satellite_name(*satellite).to_lowercase());
    let columns: Vec<_> = satellites.iter().map(name).collect();
    let row = |reports: &[(f64, SatelliteReport)]| {
        let value = |satellite: &u8| {
            let report = reports.iter().find(|(_, report)| report.satellite == *satellite);
            report.map_or(f64::NAN, |(_, report)| of(report))
        };
        (reports[0].0, satellites.iter().map(value).collect())
    };
    Stream { topic: topic.to_owned(), columns, rows: epochs(residuals).map(row).collect() }
}

/// The reports grouped by epoch, each with at least one satellite.
fn epochs(residuals: &[(f64, SatelliteReport)]) -> impl Iterator<Item = &[(f64, SatelliteReport)]> {
    residuals.chunk_by(|(a, _), (b, _)| a == b)
}
