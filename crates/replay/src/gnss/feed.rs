//! A filter that is fed with one epoch after the other.

use kestirim_gnss_files::Observed;
use kestirim_gnss_ppp::{Direction, Geodetic, Receiver};
use kestirim_ppp_filter::{Config, PppFilter, SatelliteObservation};
use nalgebra::Vector3;

use super::choices::Systems;
use super::fixing::Fixer;
use super::followed::{Followed, Order, Pass};
use super::model::Epoch;
use super::outage::{Outage, Unused};
use super::recording::Recording;
use super::single::bound;

/// A filter, and what it must be told of the epochs before.
#[derive(Debug)]
pub(super) struct Feed<const N: usize> {
    filter: PppFilter<N>,
    order: Order,
    systems: Systems,
    with_residuals: bool,
    /// Which satellites were lost since the filter took them in: an epoch without a solution tells it nothing.
    lost: [bool; 256],
    /// Tells which satellites stand below the mask, and nothing else.
    about: Option<Vector3<f64>>,
}

impl<const N: usize> Feed<N> {
    /// With a fresh filter.
    pub(super) fn new(config: &Config, recording: &Recording, pass: Pass) -> Self {
        let Pass { systems, order, with_residuals, .. } = pass;
        let about = recording.approximate_position().map(Vector3::from);
        let filter = PppFilter::new(*config);
        Self { filter, order, systems, with_residuals, lost: [false; 256], about }
    }

    /// Takes an epoch of a recording, and tells what became of it.
    pub(super) fn take(
        &mut self,
        recording: &Recording,
        receiver: &Receiver<'_>,
        epoch: &Epoch,
        fixer: Option<&mut Fixer<'_, N>>,
        followed: &mut Followed,
    ) {
        let t = recording.seconds(epoch);
        let mut unused = Unused { observed: self.observed(epoch).count(), ..Unused::default() };
        // A file says what was lost since the epoch before.
        if self.order == Order::Forwards {
            self.note_lost(epoch);
        }
        let mut observations: Vec<SatelliteObservation<'_>> = Vec::new();
        for observed in self.observed(epoch) {
            let lost = self.lost[usize::from(observed.prn)];
            match recording.products().observation(epoch.time, observed) {
                Ok(observation) => {
                    observations.push(SatelliteObservation { lock_lost: lost, ..observation });
                }
                Err(reason) => followed.miss(observed.prn, reason, &mut unused),
            }
        }
        let solution = match self.order {
            Order::Forwards => self.filter.process(epoch.time, receiver, &observations),
            Order::Backwards => self.filter.process_backwards(epoch.time, receiver, &observations),
        };
        match solution {
            Ok(mut solution) => {
                if recording.products().broadcast().is_some() {
                    let config = self.filter.config();
                    bound(&mut solution, recording, epoch, receiver, config, self.systems);
                }
                if let Some(fixer) = fixer {
                    fixer.fix(epoch.time, &self.filter, &observations, &mut solution);
                }
                for report in &solution.satellites {
                    self.lost[usize::from(report.satellite)] = false;
                }
                self.about = Some(solution.position);
                unused.below_mask = observations.len().saturating_sub(solution.satellites.len());
                followed.take(t, &solution, self.with_residuals);
            }
            Err(error) => {
                let mask = self.filter.config().elevation_mask;
                unused.below_mask =
                    self.about.map_or(0, |place| below(&observations, &place, mask));
                followed.outages.add(Outage { error, t, unused });
            }
        }
        if self.order == Order::Backwards {
            self.note_lost(epoch);
        }
        followed.unused.add(&unused);
    }

    /// What was observed of the satellites that serve.
    fn observed<'a>(&self, epoch: &'a Epoch) -> impl Iterator<Item = &'a Observed> + use<'a, N> {
        let systems = self.systems;
        epoch.satellites.iter().filter(move |observed| systems.has(observed.prn))
    }

    fn note_lost(&mut self, epoch: &Epoch) {
        if epoch.power_failure {
            self.lost.fill(true);
        }
        for observed in self.observed(epoch) {
            self.lost[usize::from(observed.prn)] |= observed.loss_of_lock.contains(&true);
        }
    }
}

/// How many satellites stand below the mask.
fn below(observations: &[SatelliteObservation<'_>], place: &Vector3<f64>, mask: f64) -> usize {
    let geodetic = Geodetic::from_ecef(place);
    let is_below = |observation: &&SatelliteObservation<'_>| {
        let sight = (observation.state.position - place).normalize();
        Direction::of(&sight, &geodetic).elevation < mask
    };
    observations.iter().filter(is_below).count()
}
