//! The observations of each satellite, arc by arc.

use std::collections::BTreeMap;

use kestirim_ppp_filter::SatelliteReport;
use kestirim_replay::gnss::Followed;
use kestirim_robust_kalman::{Decision, Reason};

use crate::metrics::median;

/// The number of epochs for which a satellite may be missing without counting as set.
const GAP_EPOCHS: f64 = 10.5;

/// A report of a satellite, with its time (s).
pub type Sighting<'a> = (f64, &'a SatelliteReport);

/// All satellites of a track.
#[derive(Debug, Clone)]
pub struct Arcs<'a> {
    satellites: BTreeMap<u8, Vec<Sighting<'a>>>,
    /// The longest gap (s) within an arc.
    pub longest_gap: f64,
}

impl<'a> Arcs<'a> {
    /// The arcs of a track that kept its residuals.
    pub fn of(followed: &'a Followed) -> Self {
        let steps: Vec<_> = followed.fixes.windows(2).map(|pair| pair[1].t - pair[0].t).collect();
        let mut satellites: BTreeMap<u8, Vec<_>> = BTreeMap::new();
        for (t, report) in &followed.residuals {
            satellites.entry(report.satellite).or_default().push((*t, report));
        }
        Self { satellites, longest_gap: GAP_EPOCHS * median(&steps) }
    }

    /// Each satellite's number with all its reports in chronological order.
    pub fn satellites(&self) -> impl Iterator<Item = (u8, &[Sighting<'a>])> {
        self.satellites.iter().map(|(number, sightings)| (*number, &**sightings))
    }

    /// The reports of a satellite split into arcs from rise to setting.
    pub fn split<'b>(
        &self,
        sightings: &'b [Sighting<'a>],
    ) -> impl Iterator<Item = &'b [Sighting<'a>]> {
        let longest = self.longest_gap;
        sightings.chunk_by(move |(a, _), (b, _)| b - a <= longest)
    }
}

/// Whether an observation was rejected.
pub fn is_rejected(decision: &Decision<f64>) -> bool {
    decision.reason == Reason::Rejected
}

/// Whether an epoch's solution uses a satellite: its code, its phase or both.
pub fn is_used(report: &SatelliteReport) -> bool {
    !(is_rejected(&report.code) && is_rejected(&report.phase))
}
