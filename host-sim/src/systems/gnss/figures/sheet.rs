//! The table of satellites by quality.

use kestirim_gnss_files::satellite_name;
use kestirim_gnss_ppp::Slip;
use kestirim_ppp_filter::{SatelliteReport, Slipped};
use kestirim_robust_kalman::Decision;

use super::arcs::{Arcs, Sighting, is_rejected, is_used};
use super::residuals::Kind;
use crate::metrics::{mean, rms};
use crate::system::Sheet;

const COLUMNS: [&str; 10] = [
    "satellite",
    "first used, h",
    "last used, h",
    "epochs used",
    "codes rejected, %",
    "phases rejected, %",
    "slips",
    "RMS of codes, m",
    "RMS of phases, mm",
    "mean elevation, °",
];

/// The table with a row per satellite, ordered by the share of rejected observations, then by the residuals of the
/// phases in use, the worst first.
pub fn sheet(arcs: &Arcs<'_>) -> Sheet {
    let mut rows: Vec<_> = arcs.satellites().map(|(number, all)| Row::of(number, all)).collect();
    rows.sort_by(|a, b| b.badness().partial_cmp(&a.badness()).unwrap_or(std::cmp::Ordering::Equal));
    Sheet::new("satellites", "Satellites, the worst first", &COLUMNS)
        .caption(
            "Ordered by the share of observations that were rejected; residuals are those of observations in use.",
        )
        .with(rows.iter().map(Row::cells))
}

/// The statistics of a satellite.
#[derive(Debug, Clone)]
struct Row {
    name: String,
    /// The times of the first and last use (s); `None` if it was never used.
    used: Option<[f64; 2]>,
    epochs: usize,
    /// The shares of rejected codes and phases.
    rejected: [f64; 2],
    slips: usize,
    /// The root mean square residuals of codes and phases (m).
    residuals: [f64; 2],
    /// The elevation (rad).
    elevation: f64,
}

impl Row {
    fn of(number: u8, all: &[Sighting<'_>]) -> Self {
        let used: Vec<_> = all.iter().filter(|(_, report)| is_used(report)).collect();
        let kinds: [Kind; 2] = [|report| &report.code, |report| &report.phase];
        let each = |kind: Kind| all.iter().map(move |(_, report)| kind(report));
        let elevations: Vec<_> = all.iter().map(|(_, report)| report.direction.elevation).collect();
        Self {
            name: satellite_name(number),
            used: used.first().zip(used.last()).map(|(first, last)| [first.0, last.0]),
            epochs: used.len(),
            rejected: kinds.map(|kind| {
                each(kind).filter(|it| is_rejected(it)).count() as f64 / all.len().max(1) as f64
            }),
            slips: all.iter().filter(|(_, report)| slipped(report)).count(),
            residuals: kinds.map(|kind| residual(each(kind))),
            elevation: mean(&elevations),
        }
    }

    fn badness(&self) -> [f64; 2] {
        // A satellite that was never used counts as fitting worst.
        let phase = Some(self.residuals[1]).filter(|it| it.is_finite());
        [self.rejected[0] + self.rejected[1], phase.unwrap_or(f64::INFINITY)]
    }

    fn cells(&self) -> Vec<String> {
        let hour = |t: Option<f64>| or_dash(t.map_or(f64::NAN, |t| t / 3600.0), 2);
        let [codes, phases] = self.rejected.map(|share| format!("{:.1}", 100.0 * share));
        let [code, phase] = self.residuals;
        vec![
            self.name.clone(),
            hour(self.used.map(|[first, _]| first)),
            hour(self.used.map(|[_, last]| last)),
            self.epochs.to_string(),
            codes,
            phases,
            self.slips.to_string(),
            or_dash(code, 2),
            or_dash(1e3 * phase, 1),
            format!("{:.0}", self.elevation.to_degrees()),
        ]
    }
}

/// The root mean square of the residuals in use.
fn residual<'a>(decisions: impl Iterator<Item = &'a Decision<f64>>) -> f64 {
    let used = decisions.filter(|it| !is_rejected(it)).map(|it| it.residual);
    let used: Vec<f64> = used.collect();
    if used.is_empty() { f64::NAN } else { rms(&used) }
}

/// A number, or a dash if there is none.
fn or_dash(value: f64, decimals: usize) -> String {
    if value.is_finite() { format!("{value:.decimals$}") } else { "—".to_owned() }
}

/// Whether the phase slipped; a satellite that rises or returns does not count.
fn slipped(report: &SatelliteReport) -> bool {
    !matches!(report.slipped, None | Some(Slipped::New | Slipped::Seen(Slip::Gap)))
}
