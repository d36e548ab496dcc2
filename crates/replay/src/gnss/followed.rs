//! One filter, fed with a recording, and what becomes of each observation.

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

/// Numbers of codes and of phases.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Both {
    /// Codes.
    pub code: usize,
    /// Phases.
    pub phase: usize,
}

impl Both {
    /// Codes and phases.
    pub const fn sum(self) -> usize {
        self.code + self.phase
    }

    fn count(&mut self, report: &SatelliteReport, reason: Reason) {
        let is = |decision: &Decision<f64>| usize::from(decision.reason == reason);
        self.code += is(&report.code);
        self.phase += is(&report.phase);
    }
}

/// Slips by what showed them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Slips {
    /// The receiver said so.
    pub loss_of_lock: usize,
    /// A jump of L1 − L2.
    pub geometry_free: usize,
    /// A jump of the Melbourne–Wübbena combination.
    pub melbourne_wuebbena: usize,
    /// A phase that contradicted all others for several epochs.
    pub contradicted: usize,
    /// All phases jumped against their codes at once.
    pub clock: usize,
}

impl Slips {
    /// All of them.
    pub const fn sum(self) -> usize {
        self.loss_of_lock
            + self.geometry_free
            + self.melbourne_wuebbena
            + self.contradicted
            + self.clock
    }

    fn count(&mut self, slipped: Option<Slipped>) {
        match slipped {
            // A satellite that comes, or comes back, is no slip.
            None | Some(Slipped::New | Slipped::Seen(Slip::Gap)) => {}
            Some(Slipped::Seen(Slip::LossOfLock)) => self.loss_of_lock += 1,
            Some(Slipped::Seen(Slip::GeometryFree)) => self.geometry_free += 1,
            Some(Slipped::Seen(Slip::MelbourneWuebbena)) => self.melbourne_wuebbena += 1,
            Some(Slipped::Seen(Slip::Clock)) => self.clock += 1,
            Some(Slipped::Contradicted) => self.contradicted += 1,
        }
    }
}

/// What became of one satellite.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Tally {
    /// In how many epochs it was used.
    pub epochs: usize,
    /// Its observations that were rejected.
    pub rejected: Both,
    /// In how many epochs its orbit was not known.
    pub no_orbit: usize,
    /// In how many epochs its clock was not known.
    pub no_clock: usize,
}

/// The end of a replay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Last {
    /// Standard deviations to the east, north and up, m.
    pub sd_enu: [f64; 3],
    /// How far the position is to be trusted.
    pub health: Health,
    /// Zenith delay of the wet troposphere, m.
    pub wet_delay: f64,
}

/// Where the marker was found at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fix {
    /// Seconds since the midnight before the first epoch.
    pub t: f64,
    /// ECEF, m.
    pub position: Vector3<f64>,
}

/// What a filter made of a recording.
#[derive(Debug, Clone, Default)]
pub struct Followed {
    /// How many epochs there were.
    pub epochs: usize,
    /// Those with a solution.
    pub fixes: Vec<Fix>,
    /// Their standard deviations to the east, north and up, m.
    pub deviations: Vec<[f64; 3]>,
    /// Of each of them the receiver's clock ahead of GPS time, m, and the zenith delay of the wet troposphere, m.
    pub delays: Vec<[f64; 2]>,
    /// The last of them.
    pub last: Option<Last>,
    /// How far each of them is to be trusted.
    pub healths: Vec<Health>,
    /// How many satellites each of them is from.
    pub heard: Vec<usize>,
    /// When all phases jumped against their codes, s, and by how many milliseconds; that was repaired.
    pub clock_jumps: Vec<(f64, i32)>,
    /// When both directions of a smoothed track disagreed, s.
    pub apart: Vec<f64>,
    /// Since when all positions have been converged ones, s.
    pub converged_since: Option<f64>,
    /// Observations that the filter was given.
    pub observations: usize,
    /// Those without weight …
    pub rejected: Both,
    /// … and those with less than the full one.
    pub deweighted: Both,
    /// Ambiguities begun anew.
    pub slips: Slips,
    /// Observed satellites that the filter was not given.
    pub unused: Unused,
    /// By satellite.
    pub satellites: BTreeMap<u8, Tally>,
    /// What came of whole ambiguities, if they were asked for.
    pub fixing: Option<Fixing>,
    /// The epochs without a solution.
    pub outages: Outages,
    /// Of each satellite in each epoch, if that was asked for.
    pub residuals: Vec<(f64, SatelliteReport)>,
}

/// In which order epochs are given to a filter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Order {
    /// As they were observed.
    #[default]
    Forwards,
    /// From the last to the first.
    Backwards,
}

/// How a filter goes through epochs.
#[derive(Debug, Clone, Copy, Default)]
pub struct Pass {
    /// Whose satellites it is given.
    pub systems: Systems,
    /// In which order.
    pub order: Order,
    /// From what positions are made.
    pub method: Method,
    /// Whether ambiguities become whole numbers.
    pub ambiguities: Ambiguities,
    /// Whether to keep what became of each observation.
    pub with_residuals: bool,
}

/// Feeds a filter with `epochs`. `next` is called after each. What came of them is in the order of time, however they
/// were gone through.
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
    /// The positions to the east, north and up of a place (ECEF, m), m.
    pub fn enu_from(&self, place: &Vector3<f64>) -> Vec<[f64; 3]> {
        let rotation = Geodetic::from_ecef(place).enu_from_ecef();
        self.fixes.iter().map(|fix| (rotation * (fix.position - place)).into()).collect()
    }

    /// When solutions were not to be relied upon, s, and why.
    pub fn contradictions(&self) -> impl Iterator<Item = (f64, Contradiction)> {
        self.fixes.iter().zip(&self.healths).filter_map(|(fix, health)| match health {
            Health::Contradicted(contradiction) => Some((fix.t, *contradiction)),
            _ => None,
        })
    }

    /// Puts what was gone through from its end into the order of time.
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
