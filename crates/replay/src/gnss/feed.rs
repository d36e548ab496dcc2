//! A filter that is fed epoch by epoch.

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

/// A filter, and what it must be told of earlier epochs.
#[derive(Debug)]
pub(super) struct Feed<const N: usize> {
    filter: PppFilter<N>,
    order: Order,
    systems: Systems,
    with_residuals: bool,
    /// The satellites whose lock was lost since the filter last used them: an epoch without a solution tells the filter
    /// nothing.
    lost: [bool; 256],
    /// An approximate position, used only to tell which satellites stand below the mask.
    about: Option<Vector3<f64>>,
}

impl<const N: usize> Feed<N> {
    /// A feed with a fresh filter.
    pub(super) fn new(config: &Config, recording: &Recording, pass: Pass) -> Self {
        let Pass { systems, order, with_residuals, .. } = pass;
        let about = recording.approximate_position().map(Vector3::from);
        let filter = PppFilter::new(*config);
        Self { filter, order, systems, with_residuals, lost: [false; 256], about }
    }

    /// Processes an epoch of a recording and adds the outcome to `followed`.
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
        // A file tells what was lost since the previous epoch.
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

    /// The observations of the satellites that are used.
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

/// The number of satellites below the elevation mask.
fn below(observations: &[SatelliteObservation<'_>], place: &Vector3<f64>, mask: f64) -> usize {
    let geodetic = Geodetic::from_ecef(place);
    let is_below = |observation: &&SatelliteObservation<'_>| {
        let sight = (observation.state.position - place).normalize();
        Direction::of(&sight, &geodetic).elevation < mask
    };
    observations.iter().filter(is_below).count()
}
