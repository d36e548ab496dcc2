//! Positions from the codes of single epochs.

use kestirim_gnss_ppp::Receiver;
use kestirim_ppp_filter::{CodeObservation, Config, Error, Solution, single_point};

use super::choices::{STATES_OF_ALL, Systems};
use super::followed::{Followed, Pass};
use super::model::Epoch;
use super::outage::{Outage, Unused};
use super::products::Unusable;
use super::recording::Recording;

/// Computes the position of each epoch from its codes alone, calling `next` after each.
pub(super) fn single(
    recording: &Recording,
    epochs: &[Epoch],
    receiver: &Receiver<'_>,
    config: &Config,
    pass: Pass,
    next: &mut dyn FnMut(),
) -> Followed {
    let mut followed = Followed { epochs: epochs.len(), ..Followed::default() };
    for epoch in epochs {
        let t = recording.seconds(epoch);
        let mut unused = Unused::default();
        let codes = codes(recording, epoch, pass.systems, |satellite, missing| {
            unused.observed += 1;
            if let Some(reason) = missing {
                followed.miss(satellite, reason, &mut unused);
            }
        });
        match position(recording, epoch, receiver, &codes, config) {
            Ok(solution) => {
                unused.below_mask = codes.len().saturating_sub(solution.satellites.len());
                followed.take(t, &solution, pass.with_residuals);
            }
            Err(error) => followed.outages.add(Outage { error, t, unused }),
        }
        followed.unused.add(&unused);
        next();
    }
    // There is one code for each satellite, and no phase.
    followed.observations /= 2;
    followed
}

/// Reduces the variances of a solution to those of a position from the codes of its epoch alone, where these are
/// smaller. Errors of ephemerides stay alike for hours: many epochs tell no more than one, but not less either.
pub(super) fn bound<const N: usize>(
    solution: &mut Solution<N>,
    recording: &Recording,
    epoch: &Epoch,
    receiver: &Receiver<'_>,
    config: &Config,
    systems: Systems,
) {
    let codes = codes(recording, epoch, systems, |_, _| ());
    if let Ok(alone) = position(recording, epoch, receiver, &codes, config) {
        let share = (alone.covariance.trace() / solution.covariance.trace()).min(1.0);
        solution.covariance *= share;
        solution.covariance_enu *= share;
    }
}

fn position(
    recording: &Recording,
    epoch: &Epoch,
    receiver: &Receiver<'_>,
    codes: &[CodeObservation<'_>],
    config: &Config,
) -> Result<Solution<STATES_OF_ALL>, Error> {
    let broadcast = recording.products().broadcast();
    let ionosphere = broadcast.and_then(|broadcast| broadcast.ionosphere());
    single_point(epoch.time, receiver, codes, ionosphere, config)
}

/// The codes of an epoch; calls `tell` for each satellite with what it lacks, if anything.
fn codes<'a>(
    recording: &'a Recording,
    epoch: &Epoch,
    systems: Systems,
    mut tell: impl FnMut(u8, Option<Unusable>),
) -> Vec<CodeObservation<'a>> {
    let observed = epoch.satellites.iter().filter(|observed| systems.has(observed.prn));
    let codes = observed.filter_map(|observed| {
        let code = recording.products().code(epoch.time, observed);
        tell(observed.prn, code.err());
        code.ok()
    });
    codes.collect()
}
