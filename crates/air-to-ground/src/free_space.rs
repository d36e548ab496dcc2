//! Received levels over open ground, from a transmitter of unknown power.

use kestirim_scalar::Scalar;

use crate::Measurement;

/// Degrees of freedom of Student's t-distribution, whose tails represent antenna nulls and buildings.
const FREEDOM: f64 = 3.0;
/// Scale of the distribution, dB (a standard deviation of 6 dB): open ground seen from some tens of metres.
const SCALE: f64 = 3.5;
/// Smallest scale, dB: receivers report levels in steps of half a decibel.
const LEAST_SCALE: f64 = 0.5;
/// Degrees of freedom subtracted when the scale is estimated: place, level and antennas are fitted, too.
const FITTED: usize = 4;
/// Power gain of a dipole along its axis, relative to its maximum.
const NULL_FILL: f64 = 0.1;
/// Lower limit of the level's curvature, as a share of that of perfect data.
const LEAST_CURVATURE: f64 = 0.05;

/// The number of a link's two antennas that are upright dipoles, whose pattern has nulls upwards and downwards.
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
    /// All variants.
    pub const ALL: [Self; 3] = [Self::Isotropic, Self::OneDipole, Self::TwoDipoles];
}

/// Prior distribution of the level received at one metre.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LevelPrior<T> {
    /// Mean of the level received at one metre, dB.
    pub mean: T,
    /// Standard deviation of the level, dB.
    pub sigma: T,
}

/// A free-space channel of unknown level: received level = level at one metre − 20·log₁₀(distance) + antenna gains +
/// noise.
///
/// The noise has Student's t-distribution (ν = 3, scale 3.5 dB or that of [`FreeSpace::fitted`]). The antennas are
/// unknown, too: all three kinds are averaged. Shadowing is correlated over tens of metres, so measurements are not
/// independent: wherever the width of their likelihood matters, it is raised to a power, (1 − ρ)/(1 + ρ) for
/// neighbours with correlation ρ, as a composite likelihood (Varin, Reid and Firth, Statistica Sinica 21, 2011). At
/// most 128 measurements are read.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FreeSpace<T> {
    level: Option<LevelPrior<T>>,
    /// Scale of Student's t-distribution, dB.
    scale: T,
}

/// Largest number of measurements that are read.
const MOST: usize = 128;

/// The measurements as seen from a candidate place of the transmitter.
struct Sight<T> {
    /// Level at one metre that each measurement implies without antenna gains, dB.
    excess: [T; MOST],
    /// Gain of one upright dipole towards each measurement, dB.
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

    /// The level at one metre that each measurement implies, dB.
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

/// A fit of the measurements to a transmitter at a place.
#[derive(Clone, Copy)]
struct Fit<T> {
    /// The best-fitting level, dB.
    level: T,
    /// ln ∫ likelihood^power · prior d(level).
    log_likelihood: T,
}

impl<T: Scalar> FreeSpace<T> {
    /// Creates a channel with a prior of its level; without one, all levels are equally likely.
    pub fn new(level: Option<LevelPrior<T>>) -> Self {
        Self { level, scale: T::from_f64(SCALE) }
    }

    /// The same channel with the noise scale that the measurements show if the transmitter is at `place`, where that
    /// is smaller: cleaner flights than expected are more informative. A larger scale is not adopted, since a wrong
    /// place would cause it as well.
    pub fn fitted(&self, measurements: &[Measurement<T>], place: [T; 2]) -> Self {
        let sight = Sight::new(measurements, place);
        let Some(free) = sight.count.checked_sub(FITTED).filter(|&n| n > 0) else {
            return *self;
        };
        let (antennas, fit) = self.best_fit(&sight);
        let free = T::from_binary(free as i32, 0);
        let freedom = T::from_f64(FREEDOM);
        let mut scale = self.scale;
        // The likelihood's own fixed-point iteration: s² = Σ (ν + 1)·e²/(ν + e²/s²)/n.
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

    /// The same channel with twice the scale, but no more than expected of open ground. For regions: the residuals at
    /// the place that was fitted to the measurements are smaller than the noise.
    pub fn doubtful(&self) -> Self {
        Self { scale: (self.scale * T::TWO).min(T::from_f64(SCALE)), ..*self }
    }

    /// Logarithm of the density of the measurements, raised to `power`, if the transmitter is at `place`. Levels and
    /// antennas are integrated over; a constant is omitted. A measurement's loss is the negative received level.
    pub fn log_likelihood(&self, measurements: &[Measurement<T>], place: [T; 2], power: T) -> T {
        let sight = Sight::new(measurements, place);
        let fits = Antennas::ALL.map(|antennas| self.fit(&sight, antennas, power).log_likelihood);
        let largest = fits[0].max(fits[1]).max(fits[2]);
        let sum = fits.iter().fold(T::ZERO, |sum, &fit| sum + (fit - largest).exp());
        largest + sum.ln()
    }

    /// The level at one metre (dB) if the transmitter is at `place`, with the best-fitting antennas.
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

    /// Fits the level by iterative reweighting, and integrates over it with Laplace's approximation.
    fn fit(&self, sight: &Sight<T>, antennas: Antennas, power: T) -> Fit<T> {
        let width = self.scale * self.scale * T::from_f64(FREEDOM);
        let (prior, known) = match self.level {
            Some(LevelPrior { mean, sigma }) => (mean, (sigma * sigma).max(T::EPSILON).recip()),
            None => (T::ZERO, T::ZERO),
        };
        // From a wide kernel, which reaches all measurements, to the true one.
        let mut level = prior;
        let [widest, wider, wide] = [T::from_f64(1e3), T::from_f64(16.0), T::from_f64(4.0)];
        for widening in [widest, wider, wide, T::ONE, T::ONE, T::ONE] {
            // Never narrower than expected of open ground: measurements far from the level would not be reached.
            let wide = width.max(T::from_f64(FREEDOM)) * widening;
            let (mut sum, mut weights) = (T::ZERO, T::ZERO);
            for suggested in sight.levels(antennas) {
                let error = (suggested - level) * T::from_f64(0.1);
                // In tens of decibels, whose squares fit into fixed point.
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
