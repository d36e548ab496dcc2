//! Comma-separated tables that a replay writes.

use std::path::Path;

use kestirim_gnss_ppp::Slip;
use kestirim_ppp_filter::{SatelliteReport, Slipped};
use kestirim_robust_kalman::{Decision, Reason};

use super::accuracy::Fix;
use crate::{Error, output};

/// Writes `t,x,y,z`: a row for each position.
///
/// # Errors
/// [`Error::Write`].
pub fn write_track(path: &Path, fixes: &[Fix]) -> Result<(), Error> {
    output::write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        table.write_record(["t", "x", "y", "z"])?;
        for Fix { t, position } in fixes {
            let [x, y, z] = <[f64; 3]>::from(*position).map(|metres| format!("{metres:.6}"));
            table.write_record([format!("{t:.6}"), x, y, z])?;
        }
        table.flush()
    })
}

const RESIDUAL_COLUMNS: [&str; 13] = [
    "t",
    "prn",
    "elevation_deg",
    "azimuth_deg",
    "code_residual_m",
    "code_standardised",
    "code_weight",
    "code_reason",
    "phase_residual_m",
    "phase_standardised",
    "phase_weight",
    "phase_reason",
    "slip",
];

/// Writes what became of each observation: a row for each satellite in each epoch.
///
/// # Errors
/// [`Error::Write`].
pub fn write_residuals(path: &Path, residuals: &[(f64, SatelliteReport)]) -> Result<(), Error> {
    output::write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        table.write_record(RESIDUAL_COLUMNS)?;
        for (t, report) in residuals {
            table.write_field(format!("{t:.6}"))?;
            table.write_field(report.satellite.to_string())?;
            let direction = report.direction;
            for angle in [direction.elevation, direction.azimuth] {
                table.write_field(format!("{:.3}", angle.to_degrees()))?;
            }
            for decision in [&report.code, &report.phase] {
                let Decision { residual, standardised, weight, .. } = decision;
                table.write_field(format!("{residual:.5}"))?;
                table.write_field(format!("{standardised:.3}"))?;
                table.write_field(format!("{weight:.3}"))?;
                table.write_field(reason(decision.reason))?;
            }
            table.write_record([report.slipped.map_or("", slip)])?;
        }
        table.flush()
    })
}

/// What `reason` columns hold.
fn reason(reason: Reason) -> &'static str {
    match reason {
        Reason::Agrees => "agrees",
        Reason::NoRedundancy => "no-redundancy",
        Reason::TooFew => "too-few",
        Reason::DownWeighted => "down-weighted",
        Reason::Rejected => "rejected",
        _ => "other",
    }
}

/// What the `slip` column holds.
const fn slip(slipped: Slipped) -> &'static str {
    match slipped {
        Slipped::New => "new",
        Slipped::Seen(Slip::Gap) => "gap",
        Slipped::Seen(Slip::LossOfLock) => "loss-of-lock",
        Slipped::Seen(Slip::GeometryFree) => "geometry-free",
        Slipped::Seen(Slip::MelbourneWuebbena) => "melbourne-wuebbena",
        Slipped::Contradicted => "contradicted",
    }
}
