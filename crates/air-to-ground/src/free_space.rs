//! Received levels over open ground, from a transmitter of unknown power.

use kestirim_scalar::Scalar;

use crate::Measurement;

/// Degrees of freedom of Student's distribution: tails as antenna nulls and buildings make them.
const FREEDOM: f64 = 3.0;
/// Scale of the distribution, dB (a standard deviation of 6 dB): open ground seen from some tens of metres.
const SCALE: f64 = 3.5;
/// Least scale, dB: receivers count in halves of decibels.
const LEAST_SCALE: f64 = 0.5;
/// Place, level and antennas are fitted, too: so many measurements do not count for the scale.
const FITTED: usize = 4;
/// Power gain of a dipole along its axis, relative to its largest.
const NULL_FILL: f64 = 0.1;
/// The level's curvature is never taken for less than this share of that of perfect data.
const LEAST_CURVATURE: f64 = 0.05;

/// Number of a link's two antennas that are upright dipoles, whose pattern has nulls upwards and downwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Antennas {
    /// No dipole: the gain is the same in all directions.
    Isotropic,
    /// A dipole at one end.
    OneDipole,
    /// Dipoles at both ends.
    TwoDipoles,
}

impl Antennas {
    /// All values.
    pub const ALL: [Self; 3] = [Self::Isotropic, Self::OneDipole, Self::TwoDipoles];
}

/// Prior distribution of the level at one metre.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LevelPrior<T> {
    /// Mean of the level received at one metre, dB.
    pub mean: T,
    /// Standard deviation of the level, dB.
    pub sigma: T,
}

/// A free-space channel of unknown level: received level = level at one metre − 20·log₁₀(distance) +
/// antennas + noise.
///
/// The noise has Student's distribution (ν = 3, scale 3.5 dB or what [`FreeSpace::fitted`] finds); which antennas there are is not known either, so
/// that all three kinds are averaged. Shadowing is alike along tens of metres, therefore measurements are not
/// independent: their likelihood is raised to a power, (1 − ρ)/(1 + ρ) for neighbours of correlation
/// ρ, wherever its width matters. At most 128 measurements are read. A composite likelihood (Varin, Reid and Firth, Statistica Sinica 21, 2011).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FreeSpace<T> {
    level: Option<LevelPrior<T>>,
    /// Scale of Student's distribution, dB.
    scale: T,
}

/// Largest number of measurements that are read.
const MOST: usize = 128;

/// Geometry of the measurements seen from a place.
struct Sight<T> {
    /// Received level beyond one of 0 dB at one metre, dB.
    excess: [T; MOST],
    /// Gain of one dipole in that direction, dB.
    dipole: [T; MOST],
    count: usize,
}

impl<T: Scalar> Sight<T> {
    fn new(measurements: &[Measurement<T>], place: [T; 2]) -> Self {
        let mut sight = Self {
            excess: [T::ZERO; MOST],
            dipole: [T::ZERO; MOST],
            count: measurements.len().min(MOST),
        };
        let slots = sight.excess.iter_mut().zip(&mut sight.dipole);
        for ((excess, dipole), measurement) in slots.zip(measurements) {
            let horizontal = measurement.horizontal_distance(place);
            let distance = T::norm(&[horizontal, measurement.height()]);
            let decibels = T::from_f64(10.0 / core::f64::consts::LN_10);
            *excess = distance.ln() * decibels * T::TWO - measurement.loss();
            // A short dipole's power pattern is cos² of the elevation.
            let cosine = horizontal / distance;
            let pattern = cosine * cosine * T::from_f64(1.0 - NULL_FILL) + T::from_f64(NULL_FILL);
            *dipole = pattern.ln() * decibels;
        }
        sight
    }

    /// Levels at one metre that the measurements suggest, dB.
    fn levels(&self, antennas: Antennas) -> impl Iterator<Item = T> {
        let dipoles = match antennas {
            Antennas::Isotropic => T::ZERO,
            Antennas::OneDipole => T::ONE,
            Antennas::TwoDipoles => T::TWO,
        };
        let pairs = self.excess.iter().zip(&self.dipole).take(self.count);
        pairs.map(move |(&excess, &dipole)| excess - dipole * dipoles)
    }
}

/// Fit of the measurements to a transmitter at a place.
#[derive(Clone, Copy)]
struct Fit<T> {
    /// The level that fits best, dB.
    level: T,
    /// ln ∫ likelihood^power · prior d(level).
    log_likelihood: T,
}

impl<T: Scalar> FreeSpace<T> {
    /// A channel with a prior of its level; without one, all levels are equally likely.
    pub fn new(level: Option<LevelPrior<T>>) -> Self {
        Self { level, scale: T::from_f64(SCALE) }
    }

    /// The same channel with the scale of the noise that the measurements show if the transmitter is at `place`,
    /// where that is smaller: cleaner flights than expected say more. A larger one is not believed, since a
    /// wrong place shows it as well.
    pub fn fitted(&self, measurements: &[Measurement<T>], place: [T; 2]) -> Self {
        let sight = Sight::new(measurements, place);
        let Some(free) = sight.count.checked_sub(FITTED).filter(|&n| n > 0) else {
            return *self;
        };
        let (antennas, fit) = self.best_fit(&sight);
        let free = T::from_binary(free as i32, 0);
        let freedom = T::from_f64(FREEDOM);
        let mut scale = self.scale;
        // The likelihood's own fixed point: s² = Σ (ν + 1)·e²/(ν + e²/s²)/n.
        for _ in 0..8 {
            let mut sum = T::ZERO;
            for level in sight.levels(antennas) {
                let error = (level - fit.level) / scale;
                let square = error.clamp(-T::from_f64(100.0), T::from_f64(100.0));
                let square = square * square;
                sum += square / (freedom + square) * (freedom + T::ONE);
            }
            scale *= (sum / free).sqrt();
            scale = scale.clamp(T::from_f64(LEAST_SCALE), self.scale);
        }
        Self { scale, ..*self }
    }

    /// The same channel with twice the scale, but no more than is expected of open ground: for regions, since
    /// measurements leave less noise at the place that they were fitted to than there is.
    pub fn doubtful(&self) -> Self {
        Self { scale: (self.scale * T::TWO).min(T::from_f64(SCALE)), ..*self }
    }

    /// Logarithm of the measurements' density if the transmitter is at `place`, to a power, levels and antennas
    /// integrated over; it lacks a constant. A measurement's loss is the negative received level.
    pub fn log_likelihood(&self, measurements: &[Measurement<T>], place: [T; 2], power: T) -> T {
        let sight = Sight::new(measurements, place);
        let fits = Antennas::ALL.map(|antennas| self.fit(&sight, antennas, power).log_likelihood);
        let largest = fits[0].max(fits[1]).max(fits[2]);
        let sum = fits.iter().fold(T::ZERO, |sum, &fit| sum + (fit - largest).exp());
        largest + sum.ln()
    }

    /// The level received at one metre (dB) if the transmitter is at `place`, by the antennas that fit best.
    pub fn level(&self, measurements: &[Measurement<T>], place: [T; 2]) -> T {
        self.best_fit(&Sight::new(measurements, place)).1.level
    }

    fn best_fit(&self, sight: &Sight<T>) -> (Antennas, Fit<T>) {
        let fit = |antennas| (antennas, self.fit(sight, antennas, T::ONE));
        let [first, second, third] = Antennas::ALL.map(fit);
        let better = |best: (Antennas, Fit<T>), fit: (Antennas, Fit<T>)| {
            if fit.1.log_likelihood > best.1.log_likelihood { fit } else { best }
        };
        better(better(first, second), third)
    }

    /// Fits the level by iterated weights, and integrates over it by Laplace's approximation.
    fn fit(&self, sight: &Sight<T>, antennas: Antennas, power: T) -> Fit<T> {
        let width = self.scale * self.scale * T::from_f64(FREEDOM);
        let (prior, known) = match self.level {
            Some(LevelPrior { mean, sigma }) => (mean, (sigma * sigma).max(T::EPSILON).recip()),
            None => (T::ZERO, T::ZERO),
        };
        // From a wide kernel, which all measurements reach, to the true one.
        let mut level = prior;
        let [widest, wider, wide] = [T::from_f64(1e3), T::from_f64(16.0), T::from_f64(4.0)];
        for widening in [widest, wider, wide, T::ONE, T::ONE, T::ONE] {
            // Never narrower than expected of open ground, or what is far from the level would not be reached.
            let wide = width.max(T::from_f64(FREEDOM)) * widening;
            let (mut sum, mut weights) = (T::ZERO, T::ZERO);
            for suggested in sight.levels(antennas) {
                let error = (suggested - level) * T::from_f64(0.1);
                // In tens of decibels, of which squares fit into fixed point.
                let weight = (wide * T::from_f64(0.01) + error * error).recip();
                sum += weight * (suggested - level);
                weights += weight;
            }
            let pull = known * T::from_f64(100.0 / (FREEDOM + 1.0)) / power;
            level += (sum + pull * (prior - level)) / (weights + pull).max(T::EPSILON);
        }
        let (mut logs, mut curvature) = (T::ZERO, T::ZERO);
        for suggested in sight.levels(antennas) {
            let error = suggested - level;
            let error = error.clamp(-T::from_f64(150.0), T::from_f64(150.0));
            let share = error / width * error;
            logs += (T::ONE + share).ln();
            let fall = (T::ONE + share).recip();
            curvature += (T::ONE - share) * fall * fall;
        }
        let count = T::from_binary(sight.count as i32, 0);
        let freedom = T::from_f64(FREEDOM + 1.0);
        let least = count * T::from_f64(LEAST_CURVATURE);
        let curvature = curvature.max(least) * power * (freedom / width) + known;
        let from_prior = (level - prior) * known.sqrt();
        let log_likelihood = -power * (freedom * T::HALF) * logs
            - from_prior * from_prior * T::HALF
            - curvature.max(T::EPSILON).ln() * T::HALF;
        Fit { level, log_likelihood }
    }
}
