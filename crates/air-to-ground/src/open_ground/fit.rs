use kestirim_scalar::Scalar;

use super::Supposition;
use super::sight::{PATTERN_DB, Row, Sight, decibels, mean_square, used};

/// Degrees of freedom of Student's distribution: tails as nulls of antennas and buildings make them.
const FREEDOM: f64 = 4.0;
/// By how much a receiver's floor and its readings waver, dB.
const WAVERING_DB: f64 = 1.7;
/// Steps of the fit, after which a further one moves no level by a tenth of a decibel.
const STEPS: usize = 5;
/// The level moves by no more in a step, dB.
const LONGEST_DB: f64 = 10.0;
/// So much above the floor a level is a signal's, dB.
const ABOVE_DB: f64 = 2.0;
/// Fewer of these do not say where the fit begins.
const FEWEST: usize = 3;
/// Powers that differ by e⁹ (39 dB) do not add anything to each other.
const FARTHEST: f64 = 9.0;

/// What a supposition and a place make of the measurements.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GroundFit<T> {
    /// ln ∫ likelihood · prior d(level, exponent, pattern), but for a constant that is the same everywhere.
    pub log_evidence: T,
    /// The level received at one metre, dB.
    pub level: T,
    /// The path-loss exponent.
    pub exponent: T,
}

impl<T: Scalar> GroundFit<T> {
    /// The level (dB) that a further measurement would show under the supposition of this fit, and its standard deviation:
    /// `from` there, so high above the transmitter, if that is at `place`.
    ///
    /// What the antennas do in that direction counts as noise: a fit does not tell it.
    pub fn expected(
        &self,
        supposition: &Supposition<T>,
        place: [T; 2],
        from: [T; 2],
        height: T,
    ) -> (T, T) {
        let distance = T::norm(&[from[0] - place[0], from[1] - place[1], height]).max(T::EPSILON);
        let signal = self.level - self.exponent * decibels(distance.ln());
        let (level, share) = supposition.received(signal);
        let pattern = T::from_f64(PATTERN_DB) * mean_square::<T>(supposition.pattern).sqrt();
        // The variance of Student's distribution is that of its scale, times ν / (ν − 2).
        let scale = supposition.scale * T::from_f64(FREEDOM / (FREEDOM - 2.0)).sqrt();
        (level, T::norm(&[share * scale, share * pattern, T::from_f64(WAVERING_DB)]))
    }
}

impl<T: Scalar> Supposition<T> {
    /// The level that a receiver shows of a signal, and by how much it changes with the signal: from zero in the floor to one
    /// above it.
    fn received(&self, signal: T) -> (T, T) {
        let (level, share) = match self.floor {
            Some(floor) => above(floor, signal),
            None => (signal, T::ONE),
        };
        match self.ceiling {
            Some(ceiling) if level > ceiling => (ceiling, T::ZERO),
            _ => (level, share),
        }
    }
}

/// Normal equations of a step.
struct Normal<T, const P: usize> {
    matrix: [[T; P]; P],
    vector: [T; P],
    used: usize,
}

pub(super) fn fit<T: Scalar, const P: usize>(
    sight: &Sight<T, P>,
    supposition: &Supposition<T>,
    power: T,
) -> GroundFit<T> {
    let used = used(supposition.pattern);
    let mut parameters = [T::ZERO; P];
    parameters[0] = start(sight, supposition) / sight.level[1];
    let mut log_evidence = T::ZERO;
    for step in 0..=STEPS {
        let is_last = step == STEPS;
        let mut normal = Normal::new(used, &parameters);
        let mut log_likelihood = T::ZERO;
        for row in sight.rows() {
            let seen = Seen::new(row, &parameters, used, supposition);
            if is_last {
                log_likelihood += seen.log_density();
            }
            normal.add(row, &seen, power);
        }
        let log_determinant = normal.decompose();
        if is_last {
            let mut squares = T::ZERO;
            for parameter in parameters.iter().take(used) {
                squares += *parameter * *parameter;
            }
            log_evidence = power * log_likelihood - squares * T::HALF - log_determinant;
        } else {
            let change = normal.solve();
            let far = change[0].abs() * sight.level[1];
            let longest = T::from_f64(LONGEST_DB);
            let share = if far > longest { longest / far } else { T::ONE };
            for (parameter, change) in parameters.iter_mut().zip(change) {
                *parameter += share * change;
            }
        }
    }
    let [level, exponent] = sight.named(&parameters);
    GroundFit { log_evidence, level, exponent }
}

/// By how much the signals are stronger than expected on average, dB.
fn start<T: Scalar, const P: usize>(sight: &Sight<T, P>, supposition: &Supposition<T>) -> T {
    let is_signal = |row: &&Row<T, P>| {
        supposition.floor.is_none_or(|floor| row.level > floor + T::from_f64(ABOVE_DB))
    };
    let mean = |signals: bool| {
        let (mut mean, mut count) = (T::ZERO, 0);
        for row in sight.rows().iter().filter(|row| !signals || is_signal(row)) {
            count += 1;
            mean += (row.level - row.expected - mean) / T::from_binary(count, 0);
        }
        (mean, count as usize)
    };
    let (of_signals, count) = mean(true);
    if count < FEWEST { mean(false).0 } else { of_signals }
}

/// A measurement beside what is expected of it.
struct Seen<T> {
    /// Difference, dB.
    error: T,
    /// By how much the level changes with the signal: from zero in the floor to one above it.
    share: T,
    /// Square of the noise's scale, dB².
    variance: T,
    /// Square of the error in units of that.
    square: T,
}

impl<T: Scalar> Seen<T> {
    fn new<const P: usize>(
        row: &Row<T, P>,
        parameters: &[T; P],
        used: usize,
        supposition: &Supposition<T>,
    ) -> Self {
        let mut signal = row.expected;
        for (slope, parameter) in row.slopes.iter().zip(parameters).take(used) {
            signal += *slope * *parameter;
        }
        let (level, share) = supposition.received(signal);
        let scale = share * supposition.scale;
        let variance = scale * scale + T::from_f64(WAVERING_DB * WAVERING_DB);
        let error = (row.level - level).clamp(-T::from_f64(150.0), T::from_f64(150.0));
        Self { error, share, variance, square: error / variance * error }
    }

    /// Without its constant.
    fn log_density(&self) -> T {
        let freedom = T::from_f64(FREEDOM);
        let tail = (T::ONE + self.square / freedom).ln() * (freedom + T::ONE);
        -(self.variance.ln() + tail) * T::HALF
    }
}

/// The power of a signal and of a floor together, dB, and the signal's share in it.
fn above<T: Scalar>(floor: T, signal: T) -> (T, T) {
    let decibels = T::from_f64(10.0 / core::f64::consts::LN_10);
    let below = (floor - signal) / decibels;
    if below > T::from_f64(FARTHEST) {
        (floor, T::ZERO)
    } else if below < -T::from_f64(FARTHEST) {
        (signal, T::ONE)
    } else {
        let sum = T::ONE + below.exp();
        (signal + decibels * sum.ln(), sum.recip())
    }
}

impl<T: Scalar, const P: usize> Normal<T, P> {
    /// Of the prior alone: all parameters are 0 ± 1.
    fn new(used: usize, parameters: &[T; P]) -> Self {
        let vector = parameters.map(|parameter| -parameter);
        let mut matrix = [[T::ZERO; P]; P];
        for (index, row) in matrix.iter_mut().enumerate() {
            row[index] = T::ONE;
        }
        Self { matrix, vector, used }
    }

    fn add(&mut self, row: &Row<T, P>, seen: &Seen<T>, power: T) {
        let freedom = T::from_f64(FREEDOM);
        let weight = power * (freedom + T::ONE) / (freedom + seen.square) / seen.variance;
        let (slope, error) = (weight * seen.share, seen.error);
        let used = self.used;
        for (index, line) in self.matrix.iter_mut().enumerate().take(used) {
            let factor = slope * row.slopes[index];
            self.vector[index] += factor * error;
            let factor = factor * seen.share;
            for (entry, other) in line.iter_mut().zip(&row.slopes).take(index + 1) {
                *entry += factor * *other;
            }
        }
    }

    /// Cholesky's factor in the place of the matrix; half the logarithm of the determinant.
    fn decompose(&mut self) -> T {
        let mut log_determinant = T::ZERO;
        // Constant bounds, so that the compiler sees that no index is out of them.
        for row in 0..P {
            if row >= self.used {
                break;
            }
            for column in 0..=row {
                let mut sum = self.matrix[row][column];
                for index in 0..column {
                    sum -= self.matrix[row][index] * self.matrix[column][index];
                }
                self.matrix[row][column] = if row == column {
                    // The prior alone makes it one.
                    let root = sum.max(T::HALF).sqrt();
                    log_determinant += root.ln();
                    root
                } else {
                    sum / self.matrix[column][column]
                };
            }
        }
        log_determinant
    }

    /// The parameters' change, by the factor.
    fn solve(&self) -> [T; P] {
        let mut change = self.vector;
        for row in 0..P {
            if row >= self.used {
                break;
            }
            let mut sum = change[row];
            for index in 0..row {
                sum -= self.matrix[row][index] * change[index];
            }
            change[row] = sum / self.matrix[row][row];
        }
        for row in (0..P).rev() {
            // What is beyond those that are used is zero, and changes nothing.
            let mut sum = change[row];
            for index in row + 1..P {
                sum -= self.matrix[index][row] * change[index];
            }
            change[row] = sum / self.matrix[row][row];
        }
        change
    }
}
