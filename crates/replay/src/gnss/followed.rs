//! A recording fed to one filter, and the outcome for each observation.

use std::collections::BTreeMap;

use super::choices::{Ambiguities, Method, STATES, STATES_OF_ALL, STATES_WITH_GALILEO, Systems};
use super::feed::Feed;
use super::fixing::{Fixer, Fixing};
use super::model::Epoch;
use super::outage::{Outages, Unused};
use super::products::Unusable;
use super::recording::Recording;
use super::single::single;
use kestirim_gnss_files::System;
use kestirim_gnss_ppp::{Geodetic, Receiver, Slip};
use kestirim_ppp_filter::{Config, Contradiction, Health, SatelliteReport, Slipped, Solution};
use kestirim_robust_kalman::{Decision, Reason};
use nalgebra::Vector3;

/// Counts of codes and of phases.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Both {
    /// The number of codes.
    pub code: usize,
    /// The number of phases.
    pub phase: usize,
}

impl Both {
    /// The number of codes and phases together.
    pub const fn sum(self) -> usize {
        self.code + self.phase
    }

    fn count(&mut self, report: &SatelliteReport, reason: Reason) {
        let is = |decision: &Decision<f64>| usize::from(decision.reason == reason);
        self.code += is(&report.code);
        self.phase += is(&report.phase);
    }
}

/// Counts of cycle slips by what showed them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Slips {
    /// Slips that the receiver reported.
    pub loss_of_lock: usize,
    /// Slips shown by a jump of L1 − L2.
    pub geometry_free: usize,
    /// Slips shown by a jump of the Melbourne–Wübbena combination.
    pub melbourne_wuebbena: usize,
    /// Phases that contradicted all others for several epochs.
    pub contradicted: usize,
    /// Slips at which all phases jumped against their codes at once.
    pub clock: usize,
}

impl Slips {
    /// The number of slips of all kinds.
    pub const fn sum(self) -> usize {
        self.loss_of_lock
            + self.geometry_free
            + self.melbourne_wuebbena
            + self.contradicted
            + self.clock
    }

    fn count(&mut self, slipped: Option<Slipped>) {
        match slipped {
            // A satellite that appears or reappears is not a slip.
            None | Some(Slipped::New | Slipped::Seen(Slip::Gap)) => {}
            Some(Slipped::Seen(Slip::LossOfLock)) => self.loss_of_lock += 1,
            Some(Slipped::Seen(Slip::GeometryFree)) => self.geometry_free += 1,
            Some(Slipped::Seen(Slip::MelbourneWuebbena)) => self.melbourne_wuebbena += 1,
            Some(Slipped::Seen(Slip::Clock)) => self.clock += 1,
            Some(Slipped::Contradicted) => self.contradicted += 1,
        }
    }
}

/// The outcome for one satellite.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Tally {
    /// The number of epochs in which it was used.
    pub epochs: usize,
    /// The numbers of its observations that were rejected.
    pub rejected: Both,
    /// The number of epochs in which its orbit was unknown.
    pub no_orbit: usize,
    /// The number of epochs in which its clock was unknown.
    pub no_clock: usize,
}

/// The last solution of a replay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Last {
    /// Standard deviations to the east, north and up, m.
    pub sd_enu: [f64; 3],
    /// How far the position is to be trusted.
    pub health: Health,
    /// Zenith delay of the wet troposphere, m.
    pub wet_delay: f64,
}

/// The position of the marker at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fix {
    /// The time, s since the midnight before the first epoch.
    pub t: f64,
    /// The position (ECEF), m.
    pub position: Vector3<f64>,
}

/// The result of a filter for a recording.
#[derive(Debug, Clone, Default)]
pub struct Followed {
    /// The number of epochs.
    pub epochs: usize,
    /// The positions of the epochs with a solution.
    pub fixes: Vec<Fix>,
    /// The standard deviations of the positions to the east, north and up, m.
    pub deviations: Vec<[f64; 3]>,
    /// For each position, the receiver clock's lead over GPS time, m, and the zenith delay of the wet troposphere, m.
    pub delays: Vec<[f64; 2]>,
    /// The last solution.
    pub last: Option<Last>,
    /// How far each position is to be trusted.
    pub healths: Vec<Health>,
    /// The number of satellites used for each position.
    pub heard: Vec<usize>,
    /// The times at which all phases jumped against their codes, s, and by how many milliseconds; the jumps were
    /// repaired.
    pub clock_jumps: Vec<(f64, i32)>,
    /// The times at which both directions of a smoothed track disagreed, s.
    pub apart: Vec<f64>,
    /// The time since which all positions have been converged, s.
    pub converged_since: Option<f64>,
    /// The number of observations given to the filter.
    pub observations: usize,
    /// Observations with zero weight.
    pub rejected: Both,
    /// Observations with reduced weight.
    pub deweighted: Both,
    /// Ambiguities that began anew, by their cause.
    pub slips: Slips,
    /// Observed satellites that were not given to the filter.
    pub unused: Unused,
    /// The outcome for each satellite.
    pub satellites: BTreeMap<u8, Tally>,
    /// The outcome of fixing ambiguities to integers, if that was requested.
    pub fixing: Option<Fixing>,
    /// The epochs without a solution.
    pub outages: Outages,
    /// The time and the report of each satellite in each epoch, if that was requested.
    pub residuals: Vec<(f64, SatelliteReport)>,
}

/// The order in which epochs are given to a filter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Order {
    /// In the order of observation.
    #[default]
    Forwards,
    /// From the last to the first.
    Backwards,
}

/// The settings of one pass of a filter through epochs.
#[derive(Debug, Clone, Copy, Default)]
pub struct Pass {
    /// The systems whose satellites are used.
    pub systems: Systems,
    /// The order of the epochs.
    pub order: Order,
    /// What positions are computed from.
    pub method: Method,
    /// Whether ambiguities are fixed to integers.
    pub ambiguities: Ambiguities,
    /// Whether to keep the outcome of each observation.
    pub with_residuals: bool,
}

/// Feeds `epochs` to a filter, calling `next` after each. The result is in the order of time, whatever the order of the
/// pass.
pub fn follow(
    recording: &Recording,
    epochs: &[Epoch],
    receiver: &Receiver<'_>,
    config: Config,
    pass: Pass,
    next: &mut dyn FnMut(),
) -> Followed {
    let config = recording.settled(config);
    if pass.method == Method::Single {
        return single(recording, epochs, receiver, &config, pass, next);
    }
    let serves = |system: &System| *system != System::Gps && pass.systems.has_system(*system);
    let mut others = recording.systems().filter(serves);
    match (others.next(), others.next()) {
        (None, _) => feed::<STATES>(&config, recording, epochs, receiver, pass, next),
        (Some(System::Galileo), None) => {
            feed::<STATES_WITH_GALILEO>(&config, recording, epochs, receiver, pass, next)
        }
        _ => feed::<STATES_OF_ALL>(&config, recording, epochs, receiver, pass, next),
    }
}

fn feed<const N: usize>(
    config: &Config,
    recording: &Recording,
    epochs: &[Epoch],
    receiver: &Receiver<'_>,
    pass: Pass,
    next: &mut dyn FnMut(),
) -> Followed {
    let mut feed = Feed::<N>::new(config, recording, pass);
    let mut fixer = (pass.ambiguities == Ambiguities::Fixed).then(|| Fixer::new(recording));
    let mut followed = Followed { epochs: epochs.len(), ..Followed::default() };
    let is_backwards = pass.order == Order::Backwards;
    for index in 0..epochs.len() {
        let epoch = &epochs[if is_backwards { epochs.len() - 1 - index } else { index }];
        feed.take(recording, receiver, epoch, fixer.as_mut(), &mut followed);
        next();
    }
    followed.fixing = fixer.map(Fixer::finish);
    if is_backwards {
        followed.turn();
    }
    followed
}

impl Followed {
    /// The positions relative to a place (ECEF, m), to the east, north and up, m.
    pub fn enu_from(&self, place: &Vector3<f64>) -> Vec<[f64; 3]> {
        let rotation = Geodetic::from_ecef(place).enu_from_ecef();
        self.fixes.iter().map(|fix| (rotation * (fix.position - place)).into()).collect()
    }

    /// The times at which solutions were not to be relied upon, s, and why.
    pub fn contradictions(&self) -> impl Iterator<Item = (f64, Contradiction)> {
        self.fixes.iter().zip(&self.healths).filter_map(|(fix, health)| match health {
            Health::Contradicted(contradiction) => Some((fix.t, *contradiction)),
            _ => None,
        })
    }

    /// Puts the results of a backward pass into the order of time.
    fn turn(&mut self) {
        self.fixes.reverse();
        self.deviations.reverse();
        self.delays.reverse();
        self.healths.reverse();
        self.heard.reverse();
        self.clock_jumps.reverse();
        self.residuals.reverse();
        self.converged_since = None;
    }

    pub(super) fn miss(&mut self, prn: u8, reason: Unusable, unused: &mut Unused) {
        let tally = self.satellites.entry(prn).or_default();
        match reason {
            Unusable::Incomplete => unused.incomplete += 1,
            Unusable::NoOrbit => {
                unused.no_orbit += 1;
                tally.no_orbit += 1;
            }
            Unusable::NoClock => {
                unused.no_clock += 1;
                tally.no_clock += 1;
            }
        }
    }

    pub(super) fn take<const N: usize>(
        &mut self,
        t: f64,
        solution: &Solution<N>,
        with_residuals: bool,
    ) {
        self.fixes.push(Fix { t, position: solution.position });
        let sd_enu = solution.deviations_enu();
        self.deviations.push(sd_enu);
        self.delays.push([solution.clock, solution.wet_delay]);
        self.last = Some(Last { sd_enu, health: solution.health, wet_delay: solution.wet_delay });
        self.healths.push(solution.health);
        self.heard.push(solution.satellites.len());
        if solution.milliseconds != 0 {
            self.clock_jumps.push((t, solution.milliseconds));
        }
        if solution.health == Health::Converged {
            self.converged_since.get_or_insert(t);
        } else {
            self.converged_since = None;
        }
        for report in &solution.satellites {
            let tally = self.satellites.entry(report.satellite).or_default();
            tally.epochs += 1;
            tally.rejected.count(report, Reason::Rejected);
            self.observations += 2;
            self.rejected.count(report, Reason::Rejected);
            self.deweighted.count(report, Reason::DownWeighted);
            self.slips.count(report.slipped);
            if with_residuals {
                self.residuals.push((t, *report));
            }
        }
    }
}
