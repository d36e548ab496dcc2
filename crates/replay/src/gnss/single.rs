//! Positions from the codes of one epoch each.

use kestirim_gnss_ppp::Receiver;
use kestirim_ppp_filter::{CodeObservation, Config, Error, Solution, single_point};

use super::choices::{STATES_OF_ALL, Systems};
use super::followed::{Followed, Pass};
use super::model::Epoch;
use super::outage::{Outage, Unused};
use super::products::Unusable;
use super::recording::Recording;

/// The position of each epoch from its codes alone. `next` is called after each.
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
    // Of each satellite one code, and no phase.
    followed.observations /= 2;
    followed
}

/// Takes the variances of a solution down to those that the codes of its epoch have by themselves, where it has larger ones.
/// Errors of ephemerides stay alike for hours: so many epochs tell as much as one, but none of them less.
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

/// The codes of an epoch; each satellite is told with what is missing of it.
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
