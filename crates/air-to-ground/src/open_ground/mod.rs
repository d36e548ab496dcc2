//! Received levels from a transmitter of which little is known.

mod abreast;
mod added;
mod fit;
mod lanes;
mod normal;
mod sight;

use kestirim_scalar::Scalar;

pub use self::fit::GroundFit;
use self::sight::{PARAMETERS, Sight, TURNED};
use crate::{Heading, LevelPrior, Measurement};

/// Largest number of measurements that are read.
const MOST: usize = 128;
/// Mean and standard deviation of the path-loss exponent of recorded links over open ground: 2 in free space, less
/// above a reflecting ground, more along it.
const EXPONENT: [f64; 2] = [2.0, 0.6];
/// Distance at which an unknown level is estimated, m: the distances of a flight are around it on a logarithmic scale,
/// so that level and exponent are nearly uncorrelated.
const REFERENCE_M: f64 = 50.0;
/// Standard deviation of an unknown level about the mean of all received levels, dB.
const LEVEL_DB: f64 = 12.0;
/// Candidate noise scales, dB: a factor of 1.8 apart, so that one is within a third of the true one.
const SCALES_DB: [f64; 3] = [1.2, 2.2, 4.0];
/// Quantiles of the received levels that are candidates for the receiver's floor.
const FLOORS: [f64; 3] = [0.1, 0.35, 0.65];
/// Prior probability that the levels have no floor.
const NO_FLOOR: f64 = 0.3;
/// This many measurements within [`SATURATED_DB`] of the strongest indicate the receiver's limit.
const SATURATED: usize = 4;
/// Tolerance within which levels count as equal, dB; levels are reported in halves of decibels at best.
const SATURATED_DB: f64 = 0.25;

/// Headings whose unit vectors have a mean of this length are within some 25° of each other.
const SAME_WAY: f64 = 0.9;

/// The largest number of [`Supposition`]s: of four patterns, four floors and three scales.
pub const SUPPOSITIONS: usize = Pattern::ALL.len() * (FLOORS.len() + 1) * SCALES_DB.len();

/// The combined gain pattern of both antennas of a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Pattern {
    /// The gain is the same in all directions.
    Isotropic,
    /// The gain depends on the elevation alone, as that of upright dipoles does.
    Upright,
    /// Any pattern fixed to the ground, such as that of dipoles whose axes are unknown.
    Tilted,
    /// Any pattern of the transmitter and any that turns with the drone, such as that of an antenna at its side.
    Turned,
}

impl Pattern {
    /// All variants.
    pub const ALL: [Self; 4] = [Self::Isotropic, Self::Upright, Self::Tilted, Self::Turned];

    /// The prior probability, with and without known headings: few antennas are isotropic, and those of animals and
    /// drones are seldom upright.
    fn share<T: Scalar>(self, is_headed: bool) -> T {
        let either = |with: T, without: T| if is_headed { with } else { without };
        match self {
            Self::Isotropic => either(T::from_f64(0.15), T::from_f64(0.2)),
            Self::Upright => either(T::from_f64(0.2), T::from_f64(0.3)),
            Self::Tilted => either(T::from_f64(0.3), T::from_f64(0.5)),
            Self::Turned => either(T::from_f64(0.35), T::ZERO),
        }
    }
}

/// A channel over open ground with unknown level, path-loss exponent, antennas, noise and receiver: received level =
/// floor ⊕ (level − 10·n·log₁₀(distance) + pattern(direction)) + noise, where ⊕ adds powers.
///
/// * The exponent n is normally distributed, 2 ± 0.6.
/// * The combined pattern of both antennas is a series of real spherical harmonics of degree 2 in the line of sight,
///   with coefficients of 0 ± 2 dB each, as two dipoles with unknown axes have in that degree (one has 3.2 dB, in five
///   coefficients); or only the harmonic that is the same all around; or none. Prior probabilities: 0.5, 0.3, 0.2.
/// * Where the drone's [`Heading`] is known, and not always the same, there is a fourth kind with the prior probability
///   0.35 (0.3, 0.2, 0.15 for the others): a second set of those harmonics (0 ± 1.5 dB each, as one dipole has) turns
///   with the drone, together with the two horizontal ones of degree 1 (0 ± 2 dB): an antenna beside metal, or a patch,
///   is stronger on one side.
/// * The floor is the receiver's own noise, in which a weak signal drowns: none, or at one of three quantiles of the
///   levels. Levels at the strongest one are saturated if at least four are equal.
/// * The noise has Student's t-distribution with ν = 4. Its scale is 1.2, 2.2 or 4 dB, and in quadrature the 1.7 dB by which a
///   receiver's readings waver; that of the floor is the latter alone.
///
/// For each [`Supposition`] (pattern, floor, scale) level, exponent and coefficients are fitted, and integrated over by Laplace's
/// approximation (`MacKay`, *Information Theory, Inference, and Learning Algorithms*, ch. 27):
/// [`OpenGround::fit`]. At most 128 measurements are read, whose loss is the negative received level.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OpenGround<T> {
    level: Option<LevelPrior<T>>,
}

/// The discrete assumptions on which a fit is conditioned.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Supposition<T> {
    /// The combined gain pattern of the antennas.
    pub pattern: Pattern,
    /// The level of the receiver's own noise, dB, if any signal is that weak.
    pub floor: Option<T>,
    /// The level at which the receiver saturates, dB, if any signal is that strong.
    pub ceiling: Option<T>,
    /// Scale of the noise, dB.
    pub scale: T,
    /// Logarithm of the prior probability, up to a constant.
    pub log_prior: T,
}

impl<T: Scalar> OpenGround<T> {
    /// Creates a channel with a prior of its level; without one, the level may be anything.
    pub fn new(level: Option<LevelPrior<T>>) -> Self {
        Self { level }
    }

    /// All suppositions to be tried for the measurements: three quarters of [`SUPPOSITIONS`] if no heading is known,
    /// or if all are much the same. O(M²), once per flight.
    pub fn suppositions(
        &self,
        measurements: &[Measurement<T>],
        headings: &[Heading<T>],
    ) -> impl Iterator<Item = Supposition<T>> + use<T> {
        let measurements = measurements.get(..MOST).unwrap_or(measurements);
        let ceiling = ceiling(measurements);
        // Constants one by one, so that no double-precision code reaches a target.
        let scales =
            [T::from_f64(SCALES_DB[0]), T::from_f64(SCALES_DB[1]), T::from_f64(SCALES_DB[2])];
        let floors = [
            None,
            quantile(measurements, T::from_f64(FLOORS[0])),
            quantile(measurements, T::from_f64(FLOORS[1])),
            quantile(measurements, T::from_f64(FLOORS[2])),
        ];
        let shares = [T::from_f64(NO_FLOOR), T::from_f64((1.0 - NO_FLOOR) / FLOORS.len() as f64)];
        let is_headed = turns(headings.get(..MOST).unwrap_or(headings));
        let patterns =
            Pattern::ALL.into_iter().filter(move |it| is_headed || *it != Pattern::Turned);
        patterns.flat_map(move |pattern| {
            floors.into_iter().enumerate().flat_map(move |(index, floor)| {
                let share = if index == 0 { shares[0] } else { shares[1] };
                let log_prior = share.ln() + pattern.share::<T>(is_headed).ln();
                scales.map(|scale| Supposition { pattern, floor, ceiling, scale, log_prior })
            })
        })
    }

    /// Fits the measurements under a supposition, for a transmitter at a place. `power` is the power to which the
    /// likelihood is raised, less than one if the measurements are not independent. Missing headings count as unknown.
    pub fn fit(
        &self,
        measurements: &[Measurement<T>],
        headings: &[Heading<T>],
        place: [T; 2],
        supposition: &Supposition<T>,
        power: T,
    ) -> GroundFit<T> {
        if supposition.pattern == Pattern::Turned {
            let sight = Sight::<T, TURNED>::new(self.level, measurements, headings, place);
            fit::one(&sight, supposition, power)
        } else {
            let sight = Sight::<T, PARAMETERS>::new(self.level, measurements, headings, place);
            fit::one(&sight, supposition, power)
        }
    }

    /// Logarithm of the density of all measurements (to a power) if the transmitter is at a place, summed over
    /// suppositions. Each one's contribution is passed to `told` with its index.
    pub fn log_likelihood(
        &self,
        measurements: &[Measurement<T>],
        headings: &[Heading<T>],
        place: [T; 2],
        power: T,
        suppositions: &[Supposition<T>],
        mut told: impl FnMut(usize, T),
    ) -> T {
        let mut all = T::ZERO.ln();
        let mut add = |index: usize, supposition: &Supposition<T>, fit: GroundFit<T>| {
            let log = fit.log_evidence + supposition.log_prior;
            told(index, log);
            // ln(eᵃ + eᵇ).
            let (more, less) = if log > all { (log, all) } else { (all, log) };
            all = if less.is_finite() { more + (T::ONE + (less - more).exp()).ln() } else { more };
        };
        let turned = |it: &Supposition<T>| it.pattern == Pattern::Turned;
        // One after the other, so that both can use the same memory.
        if !suppositions.iter().all(turned) {
            let sight = Sight::<T, PARAMETERS>::new(self.level, measurements, headings, place);
            fit::each(&sight, suppositions, |it| !turned(it), power, &mut add);
        }
        if suppositions.iter().any(turned) {
            let sight = Sight::<T, TURNED>::new(self.level, measurements, headings, place);
            fit::each(&sight, suppositions, turned, power, &mut add);
        }
        all
    }
}

/// Whether the drone turned enough to distinguish its antenna's pattern from one that does not turn: otherwise a
/// further pattern adds uncertainty and no information.
fn turns<T: Scalar>(headings: &[Heading<T>]) -> bool {
    let (mut mean, mut count) = (Heading::unknown(), 0);
    for heading in headings.iter().filter(|heading| heading.is_known()) {
        count += 1;
        mean = mean.mean(heading, T::from_binary(count, 0).recip());
    }
    count > 0 && mean.length() < T::from_f64(SAME_WAY)
}

/// The smallest level that at least this part of all levels does not exceed; `None` without a measurement.
fn quantile<T: Scalar>(measurements: &[Measurement<T>], part: T) -> Option<T> {
    let level = |measurement: &Measurement<T>| -measurement.loss();
    let wanted = T::from_binary(measurements.len() as i32, 0) * part;
    let mut found: Option<T> = None;
    for candidate in measurements.iter().map(level) {
        let below = measurements.iter().filter(|other| level(other) <= candidate).count();
        let is_enough = T::from_binary(below as i32, 0) >= wanted;
        if is_enough && found.is_none_or(|least| candidate < least) {
            found = Some(candidate);
        }
    }
    found
}

/// The strongest level, if enough others equal it to indicate saturation.
fn ceiling<T: Scalar>(measurements: &[Measurement<T>]) -> Option<T> {
    let levels = || measurements.iter().map(|measurement| -measurement.loss());
    let strongest = levels().reduce(T::max)?;
    let alike = levels().filter(|level| strongest - *level <= T::from_f64(SATURATED_DB)).count();
    (alike >= SATURATED).then_some(strongest)
}

#[cfg(test)]
mod tests;
