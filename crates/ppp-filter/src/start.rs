//! The initial position, from the codes alone.

use crate::least_squares::Step;
use crate::{Error, SatelliteObservation};
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{Constellation, eccentricity_clock, sagnac};
use nalgebra::Vector3;

/// The position and receiver clock from one epoch's codes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CodePosition {
    /// The position, ECEF, m.
    pub(crate) position: Vector3<f64>,
    /// Receiver clock minus GPS time, m.
    pub(crate) clock: f64,
}

const ITERATIONS: usize = 12;
/// The prior variance of entirely unknown quantities, m²: the Earth's radius is 6e6 m.
const UNKNOWN: f64 = 1e15;
/// Once a step is shorter than this, m, the next one will be, too: a prior with this standard deviation loses less to
/// rounding.
const NEAR: f64 = 1e5;
/// The variance, relative to that of one code, beyond which the geometry determines nothing.
const POOR: f64 = 1e6;
/// A code whose residual exceeds this is not used for the start, m: the residual of an unmodelled troposphere does not,
/// that of an outlier that would move the linearisation does.
const LARGEST_RESIDUAL: f64 = 15.0;

/// Solves for the position by least squares on the ionosphere-free codes, begun at the Earth's centre. The worst code
/// is dropped while its residual is implausible and five others remain.
pub(crate) fn code_position(
    observations: &[SatelliteObservation<'_>],
) -> Result<CodePosition, Error> {
    let observations = observations.get(..64).unwrap_or(observations);
    // A satellite that is listed twice counts once; no more than 64 are visible from any place.
    let mut dropped = 0_u64;
    for (index, observation) in observations.iter().enumerate() {
        let before = observations.get(..index).unwrap_or(&[]);
        if before.iter().any(|other| other.satellite == observation.satellite) {
            dropped |= 1 << index;
        }
    }
    // Each system has a clock of its own: the codes of one system determine the place.
    let system = |it: &SatelliteObservation<'_>| it.carriers.constellation();
    let mut counts = Constellation::ALL.map(|of| (of, 0));
    for (index, observation) in observations.iter().enumerate() {
        let is_usable = observation.carriers.ionosphere_free(observation.code).is_finite();
        if is_usable
            && dropped & (1 << index) == 0
            && let Some((_, count)) = counts.get_mut(system(observation) as usize)
        {
            *count += 1;
        }
    }
    // Of equal counts the first.
    let (most, count) = counts
        .into_iter()
        .fold((Constellation::Gps, 0), |most, it| if it.1 > most.1 { it } else { most });
    if count >= 4 {
        for (index, observation) in observations.iter().enumerate() {
            dropped |= u64::from(system(observation) != most) << index;
        }
    }
    loop {
        let used = |index: usize| dropped & (1 << index) == 0;
        let solution = least_squares(observations, used)?;
        let (mut worst, mut most, mut count) = (0, 0.0, 0);
        for (index, observation) in observations.iter().enumerate() {
            if let Some((misfit, _)) = compare(observation, &solution).filter(|_| used(index)) {
                count += 1;
                if misfit.abs() >= most {
                    (worst, most) = (index, misfit.abs());
                }
            }
        }
        if most <= LARGEST_RESIDUAL || count <= 5 {
            return Ok(solution);
        }
        dropped |= 1 << worst;
    }
}

fn least_squares(
    observations: &[SatelliteObservation<'_>],
    used: impl Fn(usize) -> bool,
) -> Result<CodePosition, Error> {
    let mut solution = CodePosition { position: Vector3::zeros(), clock: 0.0 };
    let mut prior = UNKNOWN;
    for _ in 0..ITERATIONS {
        let mut step = Step::unknown(prior);
        let mut count = 0;
        for (index, observation) in observations.iter().enumerate() {
            if !used(index) {
                continue;
            }
            let Some((misfit, sight)) = compare(observation, &solution) else { continue };
            step.take_in(&sight, misfit, 1.0).map_err(|_| Error::PoorGeometry)?;
            count += 1;
        }
        if count < 4 {
            return Err(Error::TooFewSatellites);
        }
        solution.position += step.coordinates();
        solution.clock += step.clock();
        let length = step.length();
        prior = if length < NEAR { NEAR * NEAR } else { UNKNOWN };
        if length < 1e-2 {
            return if step.spread() < POOR { Ok(solution) } else { Err(Error::PoorGeometry) };
        }
    }
    Err(Error::PoorGeometry)
}

/// Observed minus computed, m, and the unit vector from the receiver to the satellite.
fn compare(
    observation: &SatelliteObservation<'_>,
    solution: &CodePosition,
) -> Option<(f64, Vector3<f64>)> {
    /// The zenith delay of the troposphere while it is unknown, m.
    const ZENITH_DELAY: f64 = 2.4;
    let state = &observation.state;
    let line = state.position - solution.position;
    let distance = line.norm();
    let sight = line / distance;
    let clock = state.clock + eccentricity_clock(&state.position, &state.velocity);
    // On the way from the Earth's centre there is no vertical yet.
    let radius = solution.position.norm();
    let troposphere = if (6.3e6..6.5e6).contains(&radius) {
        ZENITH_DELAY / (sight.dot(&solution.position) / radius).max(0.1)
    } else {
        0.0
    };
    let computed = distance + sagnac(&state.position, &solution.position) + solution.clock
        - SPEED_OF_LIGHT * clock
        + troposphere;
    let misfit = observation.carriers.ionosphere_free(observation.code) - computed;
    (misfit + sight.sum()).is_finite().then_some((misfit, sight))
}
