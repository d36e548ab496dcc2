use kestirim_scalar::Scalar;

use super::Supposition;
use super::added::added;
use super::sight::{PATTERN_DB, Row, Sight, decibels, mean_square, used};

/// Degrees of freedom of Student's t-distribution, whose tails represent antenna nulls and buildings.
const FREEDOM: f64 = 4.0;
/// Scale of the fluctuations of a receiver's floor and of its readings, dB.
const WAVERING_DB: f64 = 1.7;
/// Number of steps of the fit, after which a further one changes no level by a tenth of a decibel.
const STEPS: usize = 5;
/// Largest change of the level in a step, dB.
const LONGEST_DB: f64 = 10.0;
/// Levels this far above the floor count as signals, dB.
const ABOVE_DB: f64 = 2.0;
/// Least number of signals from which the fit is started; with fewer, all levels are used.
const FEWEST: usize = 3;

/// The fit of the measurements under a supposition and a place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GroundFit<T> {
    /// ln ∫ likelihood · prior d(level, exponent, pattern), up to a constant that is the same everywhere.
    pub log_evidence: T,
    /// The level received at one metre, dB.
    pub level: T,
    /// The path-loss exponent.
    pub exponent: T,
}

impl<T: Scalar> GroundFit<T> {
    /// The level (dB), and its standard deviation, that a further measurement would show under the supposition of this
    /// fit: `from` there, at `height` above the transmitter, if that is at `place`.
    ///
    /// The antennas' gain in that direction counts as noise, since a fit does not provide it.
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
    /// The level that a receiver shows for a signal, and its derivative with respect to the signal: from zero in the
    /// floor to one above it.
    fn received(&self, signal: T) -> (T, T) {
        let (level, share) = match self.floor {
            Some(floor) => added(floor, signal),
            None => (signal, T::ONE),
        };
        match self.ceiling {
            Some(ceiling) if level > ceiling => (ceiling, T::ZERO),
            _ => (level, share),
        }
    }
}

/// The normal equations of a step.
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

/// The mean excess of the signals over what is expected, dB.
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

/// The residual of a measurement and its noise.
struct Seen<T: Scalar> {
    /// The residual, dB.
    error: T,
    /// Derivative of the level with respect to the signal: from zero in the floor to one above it.
    share: T,
    /// Square of the noise scale, dB².
    variance: T,
    /// The same, prepared for division.
    divisor: T::Divisor,
    /// Square of the residual in units of the variance.
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
        let divisor = variance.divisor();
        Self { error, share, variance, divisor, square: error.divided_by(divisor) * error }
    }

    /// The log-density up to a constant.
    fn log_density(&self) -> T {
        let freedom = T::from_f64(FREEDOM);
        let tail = (T::ONE + self.square / freedom).ln() * (freedom + T::ONE);
        -(self.variance.ln() + tail) * T::HALF
    }
}

impl<T: Scalar, const P: usize> Normal<T, P> {
    /// The equations of the prior alone: all parameters are 0 ± 1.
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
        let weight = power * (freedom + T::ONE) / (freedom + seen.square);
        let weight = weight.divided_by(seen.divisor);
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

    /// Replaces the matrix with its Cholesky factor; returns half the logarithm of its determinant.
    fn decompose(&mut self) -> T {
        let mut log_determinant = T::ZERO;
        // Constant bounds, so that the compiler can prove the indices valid.
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
                    // The prior alone makes it at least one.
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

    /// Solves for the change of the parameters with the Cholesky factor.
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
            // Entries beyond the used ones are zero, and have no effect.
            let mut sum = change[row];
            for index in row + 1..P {
                sum -= self.matrix[index][row] * change[index];
            }
            change[row] = sum / self.matrix[row][row];
        }
        change
    }
}
