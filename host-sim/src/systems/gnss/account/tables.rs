//! The tables that a replay writes.

use kestirim_gnss_files::satellite_name;
use kestirim_gnss_ppp::Slip;
use kestirim_ppp_filter::{SatelliteReport, Slipped};
use kestirim_replay::gnss::{Fix, Followed, Systems};
use kestirim_robust_kalman::{Decision, Reason};

use crate::system::Table;

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

/// A row for each position: time, ECEF coordinates, standard deviations to the east, north and up.
pub(in crate::systems::gnss) fn track(followed: &Followed) -> Table {
    let row = |(Fix { t, position }, deviations): (&Fix, &[f64; 3])| {
        let position = <[f64; 3]>::from(*position).map(|metres| format!("{metres:.6}"));
        let deviations = deviations.map(|metres| format!("{metres:.6}"));
        std::iter::once(format!("{t:.6}")).chain(position).chain(deviations).collect()
    };
    Table {
        rows: followed.fixes.iter().zip(&followed.deviations).map(row).collect(),
        health: followed.healths.iter().map(|health| health.in_short().state()).collect(),
        ..Table::new(&["t", "x", "y", "z", "sde", "sdn", "sdu"])
    }
}

/// The outcome of each observation: a row for each satellite in each epoch.
pub(in crate::systems::gnss) fn residuals(residuals: &[(f64, SatelliteReport)]) -> Table {
    let row = |(t, report): &(f64, SatelliteReport)| {
        let number = report.satellite;
        // GPS satellites keep their bare numbers from when there were no other systems.
        let name =
            if Systems::Gps.has(number) { number.to_string() } else { satellite_name(number) };
        let mut row = vec![format!("{t:.6}"), name];
        let direction = report.direction;
        let angles = [direction.elevation, direction.azimuth];
        row.extend(angles.map(|angle| format!("{:.3}", angle.to_degrees())));
        for decision in [&report.code, &report.phase] {
            let Decision { residual, standardised, weight, .. } = decision;
            row.extend([format!("{residual:.5}"), format!("{standardised:.3}")]);
            row.extend([format!("{weight:.3}"), reason(decision.reason).to_owned()]);
        }
        row.push(report.slipped.map_or("", slip).to_owned());
        row
    };
    Table { rows: residuals.iter().map(row).collect(), ..Table::new(&RESIDUAL_COLUMNS) }
}

/// The text in `reason` columns.
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

/// The text in the `slip` column.
const fn slip(slipped: Slipped) -> &'static str {
    match slipped {
        Slipped::New => "new",
        Slipped::Seen(Slip::Gap) => "gap",
        Slipped::Seen(Slip::LossOfLock) => "loss-of-lock",
        Slipped::Seen(Slip::GeometryFree) => "geometry-free",
        Slipped::Seen(Slip::MelbourneWuebbena) => "melbourne-wuebbena",
        Slipped::Seen(Slip::Clock) => "clock",
        Slipped::Contradicted => "contradicted",
    }
}
