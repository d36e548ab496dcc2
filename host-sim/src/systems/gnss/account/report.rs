//! What a replay reports of one filter.

use kestirim_gnss_files::satellite_name;
use kestirim_gnss_ppp::{Correction, Geodetic, zenith_hydrostatic};
use kestirim_ppp_filter::Health;
use kestirim_replay::gnss::{
    Accuracy, Both, FilterKind, Fixing, Followed, Method, Recording, Slips, Unused,
};
use nalgebra::Vector3;
use serde::Serialize;

use crate::metrics::{error_over_sigma, percentile, rms};
use crate::system::System;
use crate::systems::gnss::Gnss;
use crate::systems::gnss::settings::{Mode, Setup};

/// The number of satellites listed as those with the most rejected observations.
const WORST: usize = 5;

/// The report that the command prints for one filter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// Always `gnss`.
    pub system: &'static str,
    /// The filter.
    pub filter: FilterKind,
    /// Whether the filter is taken as published in the paper.
    #[serde(rename = "printed")]
    pub published: bool,
    /// Whether the receiver was assumed to move.
    pub mode: Mode,
    /// The method by which positions were computed.
    pub method: Method,
    /// The number of epochs from the first one on.
    pub epochs: usize,
    /// The first and the last epoch in UTC, as `2020-06-25 12:00:00 UTC`.
    pub utc: [String; 2],
    /// The number of epochs with a solution that nothing contradicts.
    pub solved: usize,
    /// The number of epochs with a solution that cannot be relied upon.
    pub contradicted: usize,
    /// The last position of the marker (ECEF, m).
    pub position_ecef_m: [f64; 3],
    /// The standard deviations of the last position to the east, north and up (m).
    pub sd_enu_m: [f64; 3],
    /// The state of convergence of the last solution.
    pub convergence: &'static str,
    /// The time from which on every solution has converged, in minutes since the first epoch.
    pub converged_since_min: Option<f64>,
    /// The zenith delay of the troposphere at the end (m).
    pub zenith_delay_m: f64,
    /// The number of code and phase observations given to the filter.
    pub observations: usize,
    /// The number of observations rejected because they contradict the others.
    pub rejected: usize,
    /// The number of observations given less weight.
    pub deweighted: usize,
    /// The number of ambiguities that were reset, except for satellites that rise or return.
    pub slips: usize,
    /// The rejected observations by kind: codes and phases.
    pub rejected_by_kind: Both,
    /// The observations given less weight by kind: codes and phases.
    pub deweighted_by_kind: Both,
    /// The cycle slips by the means that detected them.
    pub slips_by_kind: Slips,
    /// The satellites with the most rejected observations.
    pub most_rejected: Vec<Rejections>,
    /// Observed satellites that were not used, counted once per epoch.
    pub unused: Unused,
    /// The results of ambiguity fixing, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ambiguities: Option<Fixing>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
    /// The accuracy, if the truth is known.
    pub accuracy: Option<Accuracy>,
    /// The results of forward–backward smoothing, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothed: Option<SmoothedReport>,
}

/// The results of a filter run forwards and backwards.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SmoothedReport {
    /// The number of epochs with a position.
    pub positions: usize,
    /// The most accurate position (ECEF, m); for a stationary receiver, its position.
    pub position_ecef_m: [f64; 3],
    /// The standard deviations of that position to the east, north and up (m).
    pub sd_enu_m: [f64; 3],
    /// The root mean square 3-D error of all positions from the first one on, if the truth is known (m).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rms_3d_m: Option<f64>,
    /// The largest 3-D error of all positions, if the truth is known (m).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_3d_m: Option<f64>,
    /// The root mean square 3-D error divided by the root mean square standard deviation, if the truth is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_over_sigma: Option<f64>,
}

impl SmoothedReport {
    fn of(smoothed: &Followed, truth: Option<&Vector3<f64>>) -> Option<Self> {
        let pairs = || smoothed.fixes.iter().zip(&smoothed.deviations);
        let norm = |deviations: &[f64; 3]| Vector3::from(*deviations).norm();
        let (best, sd_enu_m) = pairs().min_by(|a, b| norm(a.1).total_cmp(&norm(b.1)))?;
        let told: Option<Vec<_>> = truth.map(|truth| {
            pairs().map(|(fix, sd)| ((fix.position - truth).norm(), norm(sd))).collect()
        });
        let errors =
            told.as_ref().map(|told| told.iter().map(|(error, _)| *error).collect::<Vec<_>>());
        Some(Self {
            positions: smoothed.fixes.len(),
            position_ecef_m: best.position.into(),
            sd_enu_m: *sd_enu_m,
            rms_3d_m: errors.as_deref().map(rms),
            max_3d_m: errors.as_deref().map(|errors| percentile(errors, 100.0)),
            error_over_sigma: told.and_then(error_over_sigma),
        })
    }

    fn facts(&self) -> Vec<(&'static str, String)> {
        let [x, y, z] = self.position_ecef_m;
        let sigma = enu(self.sd_enu_m);
        let mut facts = vec![(
            "smoothed, best position (ECEF)",
            format!("{x:.4} m, {y:.4} m, {z:.4} m ({sigma})"),
        )];
        if let (Some(rms), Some(most)) = (self.rms_3d_m, self.max_3d_m) {
            let rms = format!("{}, at most {}", millimetres(rms), millimetres(most));
            facts.push(("smoothed, RMS from the first epoch", rms));
        }
        facts
    }
}

/// The rejected observations of a satellite.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Rejections {
    /// The name of the satellite.
    pub satellite: String,
    /// The number of epochs in which it was used.
    pub epochs: usize,
    /// The rejected codes and phases.
    #[serde(flatten)]
    pub rejected: Both,
}

impl Report {
    /// The report of a filter; `None` if it found no position at all.
    pub(super) fn new(
        recording: &Recording,
        setup: &Setup,
        filter: FilterKind,
        followed: &Followed,
        smoothed: Option<&Followed>,
        warnings: Vec<String>,
    ) -> Option<Self> {
        let (last, fix) = (followed.last?, followed.fixes.last()?);
        let [begin, _] = recording.span();
        let dry = if setup.corrections.has(Correction::Troposphere) {
            zenith_hydrostatic(&Geodetic::from_ecef(&fix.position))
        } else {
            0.0
        };
        let truth = setup.truth(recording);
        Some(Self {
            system: Gnss::NAME,
            filter,
            published: setup.published && filter.is_published(),
            mode: Mode::of(setup.motion),
            method: setup.method,
            epochs: followed.epochs,
            utc: ends(recording, setup).map(|t| recording.utc(t)),
            solved: followed.fixes.len() - followed.contradictions().count(),
            contradicted: followed.contradictions().count(),
            position_ecef_m: fix.position.into(),
            sd_enu_m: last.sd_enu,
            convergence: convergence(last.health),
            converged_since_min: followed.converged_since.map(|t| (t - begin) / 60.0),
            zenith_delay_m: dry + last.wet_delay,
            observations: followed.observations,
            rejected: followed.rejected.sum(),
            deweighted: followed.deweighted.sum(),
            slips: followed.slips.sum(),
            rejected_by_kind: followed.rejected,
            deweighted_by_kind: followed.deweighted,
            slips_by_kind: followed.slips,
            most_rejected: most_rejected(followed),
            unused: followed.unused,
            ambiguities: followed.fixing,
            warnings,
            smoothed: smoothed.and_then(|it| SmoothedReport::of(it, truth.as_ref())),
            accuracy: truth.and_then(|truth| {
                let Followed { fixes, deviations, .. } = followed;
                let accuracy = Accuracy::of(fixes, begin, &truth)?;
                Some(accuracy.with_deviations(fixes, deviations, begin, &truth))
            }),
        })
    }
}

/// The times of the first and the last epoch used (s).
fn ends(recording: &Recording, setup: &Setup) -> [f64; 2] {
    let epochs = recording.epochs(setup.until);
    [epochs.first(), epochs.last()].map(|it| it.map_or(0.0, |epoch| recording.seconds(epoch)))
}

/// The state of convergence, as named in reports.
const fn convergence(health: Health) -> &'static str {
    match health {
        Health::Converging => "converging",
        Health::Converged => "converged",
        Health::Unchecked => "unchecked",
        Health::Contradicted(_) => "contradicted",
    }
}

fn most_rejected(followed: &Followed) -> Vec<Rejections> {
    let mut rejections: Vec<_> = followed
        .satellites
        .iter()
        .filter(|(_, tally)| tally.rejected.sum() > 0)
        .map(|(prn, tally)| Rejections {
            satellite: satellite_name(*prn),
            epochs: tally.epochs,
            rejected: tally.rejected,
        })
        .collect();
    rejections.sort_by_key(|it| std::cmp::Reverse(it.rejected.sum()));
    rejections.truncate(WORST);
    rejections
}

impl Report {
    /// The name of the filter, and whether it is taken as published.
    pub(super) fn title(&self) -> String {
        let published = if self.published { " (published)" } else { "" };
        format!("{}{published}", self.filter.name())
    }

    /// The most important results in a line.
    pub(super) fn in_a_line(&self) -> String {
        let rejected = format!("{} rejected, {} slips", self.rejected, self.slips);
        match &self.accuracy {
            Some(Accuracy { final_3d_m, rms_3d_m, .. }) => {
                let rms =
                    rms_3d_m.map_or(String::new(), |rms| format!(", RMS {}", millimetres(rms)));
                format!("final error {}{rms}, {rejected}", millimetres(*final_3d_m))
            }
            None => format!("standard deviation {}, {rejected}", enu(self.sd_enu_m)),
        }
    }

    /// The results by name.
    pub fn facts(&self) -> Vec<(&'static str, String)> {
        let mut facts = Vec::new();
        let mut fact = |name, value| facts.push((name, value));
        let mode = match self.method {
            Method::Filter => format!("{:?}", self.mode).to_lowercase(),
            Method::Single => "single epochs, codes alone".to_owned(),
        };
        fact("filter", format!("{}, {mode}", self.title()));
        let contradicted = match self.contradicted {
            0 => String::new(),
            count => format!(", {count} with one that is contradicted"),
        };
        let epochs = format!("{}, {} with a solution{contradicted}", self.epochs, self.solved);
        fact("epochs", epochs);
        let [first, last] = &self.utc;
        fact("first, last epoch", format!("{first}, {last}"));
        let [x, y, z] = self.position_ecef_m;
        fact("position (ECEF)", format!("{x:.4} m, {y:.4} m, {z:.4} m"));
        let place = Geodetic::from_ecef(&Vector3::from(self.position_ecef_m));
        let [latitude, longitude] = [place.latitude, place.longitude].map(f64::to_degrees);
        fact(
            "latitude, longitude, height",
            format!("{latitude:.9}°, {longitude:.9}°, {:.4} m", place.height),
        );
        fact("standard deviation", enu(self.sd_enu_m));
        let since = match self.converged_since_min {
            Some(minutes) => format!(", since {minutes:.1} min"),
            None => String::new(),
        };
        fact("convergence", format!("{}{since}", self.convergence));
        fact("zenith delay", format!("{:.1} mm", 1e3 * self.zenith_delay_m));
        fact("observations", self.observations.to_string());
        let both = |both: Both| format!("{} codes, {} phases", both.code, both.phase);
        fact("rejected", both(self.rejected_by_kind));
        if !self.most_rejected.is_empty() {
            let names = self
                .most_rejected
                .iter()
                .map(|it| format!("{} {}", it.satellite, it.rejected.sum()));
            fact("  most of", names.collect::<Vec<_>>().join(", "));
        }
        fact("down-weighted", both(self.deweighted_by_kind));
        fact("slips", slips(self.slips_by_kind));
        fact("not used", unused(&self.unused));
        if let Some(Fixing { epochs, first_s, fixed, ratio, success_rate }) = self.ambiguities {
            let since = first_s.map_or_else(String::new, |first| {
                format!(", the first at {first} s, {fixed} in the last (ratio {ratio:.1}, success rate {success_rate:.4})")
            });
            fact("whole ambiguities", format!("in {epochs} epochs{since}"));
        }
        if let Some(accuracy) = &self.accuracy {
            let Accuracy { final_3d_m, final_enu_m, .. } = *accuracy;
            fact("final error", format!("{} ({})", millimetres(final_3d_m), enu(final_enu_m)));
            if let (Some(all), Some(each)) = (accuracy.rms_3d_m, accuracy.rms_enu_m) {
                fact("RMS after 1 h", format!("{} ({})", millimetres(all), enu(each)));
            }
            let never = || "never for 15 min".to_owned();
            let minutes = |minutes: f64| format!("{minutes:.1} min");
            fact("below 10 cm after", accuracy.convergence_min.map_or_else(never, minutes));
        }
        facts.extend(self.smoothed.iter().flat_map(SmoothedReport::facts));
        facts
    }
}

/// A length as shown in tables.
pub fn millimetres(metres: f64) -> String {
    if metres.abs() < 10.0 { format!("{:.1} mm", 1e3 * metres) } else { format!("{metres:.3} m") }
}

fn enu([east, north, up]: [f64; 3]) -> String {
    let [east, north, up] = [east, north, up].map(millimetres);
    format!("E {east}, N {north}, U {up}")
}

fn slips(slips: Slips) -> String {
    let kinds = [
        (slips.loss_of_lock, "loss of lock"),
        (slips.geometry_free, "geometry-free"),
        (slips.melbourne_wuebbena, "Melbourne–Wübbena"),
        (slips.contradicted, "contradicted"),
        (slips.clock, "of the receiver's clock"),
    ];
    listed(&kinds)
}

fn unused(unused: &Unused) -> String {
    let kinds = [
        (unused.incomplete, "incomplete"),
        (unused.no_orbit, "without an orbit"),
        (unused.no_clock, "without a clock"),
        (unused.below_mask, "below the mask"),
    ];
    listed(&kinds)
}

fn listed(kinds: &[(usize, &str)]) -> String {
    let some = kinds.iter().filter(|(count, _)| *count > 0);
    let some: Vec<_> = some.map(|(count, kind)| format!("{count} {kind}")).collect();
    if some.is_empty() { "none".to_owned() } else { some.join(", ") }
}
