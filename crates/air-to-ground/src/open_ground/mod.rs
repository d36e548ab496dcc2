//! Received levels from a transmitter of which little is known.

mod fit;
mod sight;

use kestirim_scalar::Scalar;

pub use self::fit::GroundFit;
use self::sight::Sight;
use crate::{LevelPrior, Measurement};

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

/// How many [`Supposition`]s there are: of three patterns, four floors and three scales.
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
}

impl Pattern {
    /// All values.
    pub const ALL: [Self; 3] = [Self::Isotropic, Self::Upright, Self::Tilted];

    /// Its prior probability: few antennas have none, and those of animals and drones are seldom upright.
    fn share<T: Scalar>(self) -> T {
        match self {
            Self::Isotropic => T::from_f64(0.2),
            Self::Upright => T::from_f64(0.3),
            Self::Tilted => T::from_f64(0.5),
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

    /// All that is supposed in turn of what was received. O(M²), once for a flight.
    pub fn suppositions(&self, measurements: &[Measurement<T>]) -> [Supposition<T>; SUPPOSITIONS] {
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
        let patterns = Pattern::ALL.iter();
        let mut all = patterns.flat_map(|pattern| {
            floors.iter().enumerate().flat_map(move |(index, floor)| {
                let share = if index == 0 { shares[0] } else { shares[1] };
                let log_prior = share.ln() + pattern.share::<T>().ln();
                let (pattern, floor) = (*pattern, *floor);
                scales.map(|scale| Supposition { pattern, floor, ceiling, scale, log_prior })
            })
        });
        // There are as many.
        let first = Supposition {
            pattern: Pattern::Isotropic,
            floor: None,
            ceiling,
            scale: scales[0],
            log_prior: T::ZERO.ln(),
        };
        core::array::from_fn(|_| all.next().unwrap_or(first))
    }

    /// The measurements as a transmitter at a place explains them under a supposition: `power` is the power that the
    /// likelihood is raised to, less than one where measurements are not independent.
    pub fn fit(
        &self,
        measurements: &[Measurement<T>],
        place: [T; 2],
        supposition: &Supposition<T>,
        power: T,
    ) -> GroundFit<T> {
        fit::fit(&Sight::new(self.level, measurements, place), supposition, power)
    }

    /// Logarithm of the density of all measurements (to a power) if the transmitter is at a place, summed over
    /// suppositions: those for which `is_taken` says so. What each contributes is told to `told`.
    pub fn log_likelihood<'a>(
        &self,
        measurements: &[Measurement<T>],
        place: [T; 2],
        power: T,
        suppositions: impl IntoIterator<Item = &'a Supposition<T>>,
        mut told: impl FnMut(usize, T),
    ) -> T
    where
        T: 'a,
    {
        let sight = Sight::new(self.level, measurements, place);
        let mut all = T::ZERO.ln();
        for (index, supposition) in suppositions.into_iter().enumerate() {
            let log = fit::fit(&sight, supposition, power).log_evidence + supposition.log_prior;
            told(index, log);
            // ln(eᵃ + eᵇ).
            let (more, less) = if log > all { (log, all) } else { (all, log) };
            all = if less.is_finite() { more + (T::ONE + (less - more).exp()).ln() } else { more };
        }
        all
    }
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
