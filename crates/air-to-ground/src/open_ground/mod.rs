//! Received levels from a transmitter of which little is known.

mod fit;
mod sight;

use kestirim_scalar::Scalar;

pub use self::fit::GroundFit;
use self::sight::{PARAMETERS, Sight, TURNED};
use crate::{Heading, LevelPrior, Measurement};

/// Largest number of measurements that are read.
const MOST: usize = 128;
/// Exponents of recorded links over open ground: 2 in free space, less above a reflecting ground, more along it.
const EXPONENT: [f64; 2] = [2.0, 0.6];
/// Where the level is measured from if none is known before: the logarithms of a flight's distances are about this one,
/// m, so that level and exponent are estimated nearly apart.
const REFERENCE_M: f64 = 50.0;
/// Standard deviation of an unknown level about the mean of all that was received, dB.
const LEVEL_DB: f64 = 12.0;
/// Scales of the noise that are tried, dB: a factor of 1.8 apart, so that one is within a third of the true one.
const SCALES_DB: [f64; 3] = [1.2, 2.2, 4.0];
/// A receiver's floor is looked for at these quantiles of what was received.
const FLOORS: [f64; 3] = [0.1, 0.35, 0.65];
/// Prior probability that there is no floor among the levels.
const NO_FLOOR: f64 = 0.3;
/// This many measurements within [`SATURATED_DB`] of the strongest are a receiver's limit.
const SATURATED: usize = 4;
/// Levels are told in halves of decibels at best.
const SATURATED_DB: f64 = 0.25;

/// Headings whose unit vectors have a mean as long as this are within some 25° of each other.
const SAME_WAY: f64 = 0.9;

/// How many [`Supposition`]s there are at most: of four patterns, four floors and three scales.
pub const SUPPOSITIONS: usize = Pattern::ALL.len() * (FLOORS.len() + 1) * SCALES_DB.len();

/// What both antennas of a link together may have for a pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Pattern {
    /// None: the gain is the same in all directions.
    Isotropic,
    /// The same all around, such as that of upright dipoles: it depends on the elevation alone.
    Upright,
    /// Any, such as that of dipoles whose axes are unknown.
    Tilted,
    /// Any of a transmitter and any that turns with the drone, such as that of an antenna at its side.
    Turned,
}

impl Pattern {
    /// All values.
    pub const ALL: [Self; 4] = [Self::Isotropic, Self::Upright, Self::Tilted, Self::Turned];

    /// Its prior probability, if headings are known and if not: few antennas have none, and those of animals and drones are
    /// seldom upright.
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

/// A channel over open ground of which level, path-loss exponent, antennas, noise and receiver are unknown: received
/// level = floor ⊕ (level − 10·n·log₁₀(distance) + pattern(direction)) + noise, where ⊕ adds powers.
///
/// * The exponent n is normally distributed, 2 ± 0.6.
/// * The pattern of both antennas together is a series of real spherical harmonics of degree 2 in the line of sight, each
///   with a coefficient of 0 ± 2 dB: what two dipoles of unknown axes have of that degree (one has 3.2 dB, in five
///   coefficients); or of the one alone that is the same all around; or of none. Prior probabilities 0.5, 0.3, 0.2.
/// * Where the drone's [`Heading`] is known, and not always the same, there is a fourth kind, of prior probability 0.35 (0.3, 0.2, 0.15 for the others): of
///   those harmonics a second set (0 ± 1.5 dB each, as one dipole has it) turns with the drone, and with it the two of degree 1 that are
///   horizontal (0 ± 2 dB): an antenna beside metal, or a patch, is stronger on one side.
/// * The floor is the receiver's own noise, which a weak signal drowns in: none, or at one of three quantiles of the levels.
///   Levels at the strongest one are saturated if at least four are alike.
/// * The noise has Student's distribution with ν = 4 and a scale of 1.2, 2.2 or 4 dB; that of the floor 1.7 dB.
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

/// What a fit takes for granted.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Supposition<T> {
    /// What antennas have for a pattern.
    pub pattern: Pattern,
    /// The level of the receiver's own noise, dB, if any signal is as weak.
    pub floor: Option<T>,
    /// The level beyond which the receiver tells no more, dB, if any signal is as strong.
    pub ceiling: Option<T>,
    /// Scale of the noise, dB.
    pub scale: T,
    /// Logarithm of its prior probability, but for a constant.
    pub log_prior: T,
}

impl<T: Scalar> OpenGround<T> {
    /// A channel with a prior of its level; without one, the level may be anything.
    pub fn new(level: Option<LevelPrior<T>>) -> Self {
        Self { level }
    }

    /// All that is supposed in turn of what was received: three quarters of [`SUPPOSITIONS`] if no heading is known, or
    /// all are much the same. O(M²), once for a flight.
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

    /// The measurements as a transmitter at a place explains them under a supposition: `power` is the power that the
    /// likelihood is raised to, less than one where measurements are not independent. Headings that are not there are unknown.
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
            fit::fit(&sight, supposition, power)
        } else {
            let sight = Sight::<T, PARAMETERS>::new(self.level, measurements, headings, place);
            fit::fit(&sight, supposition, power)
        }
    }

    /// Logarithm of the density of all measurements (to a power) if the transmitter is at a place, summed over
    /// suppositions. What each contributes is told to `told` by its index.
    pub fn log_likelihood(
        &self,
        measurements: &[Measurement<T>],
        headings: &[Heading<T>],
        place: [T; 2],
        power: T,
        suppositions: &[Supposition<T>],
        mut told: impl FnMut(usize, T),
    ) -> T {
        let of_kind = |is_turned: bool| {
            let numbered = suppositions.iter().enumerate();
            numbered.filter(move |(_, it)| (it.pattern == Pattern::Turned) == is_turned)
        };
        let mut all = T::ZERO.ln();
        let mut add = |index: usize, supposition: &Supposition<T>, fit: GroundFit<T>| {
            let log = fit.log_evidence + supposition.log_prior;
            told(index, log);
            // ln(eᵃ + eᵇ).
            let (more, less) = if log > all { (log, all) } else { (all, log) };
            all = if less.is_finite() { more + (T::ONE + (less - more).exp()).ln() } else { more };
        };
        // One after the other, so that the one can be in the memory of the other.
        if of_kind(false).next().is_some() {
            let sight = Sight::<T, PARAMETERS>::new(self.level, measurements, headings, place);
            for (index, supposition) in of_kind(false) {
                add(index, supposition, fit::fit(&sight, supposition, power));
            }
        }
        if of_kind(true).next().is_some() {
            let sight = Sight::<T, TURNED>::new(self.level, measurements, headings, place);
            for (index, supposition) in of_kind(true) {
                add(index, supposition, fit::fit(&sight, supposition, power));
            }
        }
        all
    }
}

/// Whether a drone turned by so much that its antenna's pattern can be told from one that does not turn: otherwise a further
/// pattern costs certainty and tells nothing.
fn turns<T: Scalar>(headings: &[Heading<T>]) -> bool {
    let (mut mean, mut count) = (Heading::unknown(), 0);
    for heading in headings.iter().filter(|heading| heading.is_known()) {
        count += 1;
        mean = mean.mean(heading, T::from_binary(count, 0).recip());
    }
    count > 0 && mean.length() < T::from_f64(SAME_WAY)
}

/// The level below which this part of all lie; none without a measurement.
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

/// The strongest level, if so many are alike that the receiver tells no more.
fn ceiling<T: Scalar>(measurements: &[Measurement<T>]) -> Option<T> {
    let levels = || measurements.iter().map(|measurement| -measurement.loss());
    let strongest = levels().reduce(T::max)?;
    let alike = levels().filter(|level| strongest - *level <= T::from_f64(SATURATED_DB)).count();
    (alike >= SATURATED).then_some(strongest)
}

#[cfg(test)]
mod tests;
