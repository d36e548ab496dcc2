use kestirim_scalar::Scalar;

use super::{EXPONENT, LEVEL_DB, MOST, Pattern, REFERENCE_M};
use crate::{Heading, LevelPrior, Measurement};

/// Prior standard deviation of a coefficient of the pattern, dB.
pub(super) const PATTERN_DB: f64 = 2.0;
/// Standard deviation of a coefficient, in units of [`PATTERN_DB`], where transmitter and drone have coefficients of
/// their own: one dipole's (3.2 dB in five coefficients) is less than that of two.
const OWN: f64 = 0.75;
/// √3: normalises harmonics of degree 1 to a mean square of one over all directions.
const ROOT: f64 = 1.732_050_807_568_877_2;
/// √15, √5: normalise harmonics of degree 2 to a mean square of one over all directions.
const ROOTS: [f64; 2] = [3.872_983_346_207_417, 2.236_067_977_499_79];

/// Number of parameters that are fitted: level, exponent and five coefficients of the pattern, all in units of their
/// prior standard deviations.
pub(super) const PARAMETERS: usize = 7;
/// Number of parameters with a pattern that turns with the drone: four more of degree 2, and two of degree 1.
pub(super) const TURNED: usize = 13;

/// The number of parameters, counted from the first, that a pattern uses.
pub(super) fn used(pattern: Pattern) -> usize {
    match pattern {
        Pattern::Isotropic => 2,
        Pattern::Upright => 3,
        Pattern::Tilted => PARAMETERS,
        Pattern::Turned => TURNED,
    }
}

/// Prior mean square of a pattern's gain, in units of the square of [`PATTERN_DB`].
pub(super) fn mean_square<T: Scalar>(pattern: Pattern) -> T {
    match pattern {
        Pattern::Isotropic => T::ZERO,
        Pattern::Upright => T::ONE,
        Pattern::Tilted => T::from_f64(5.0),
        Pattern::Turned => T::from_f64(1.0 + 8.0 * OWN * OWN + 2.0),
    }
}

/// A measurement as seen from a place.
#[derive(Clone, Copy)]
pub(super) struct Row<T, const P: usize> {
    /// Received level, dB.
    pub(super) level: T,
    /// Level expected before the fit, dB.
    pub(super) expected: T,
    /// Derivatives of the level with respect to the parameters, dB.
    pub(super) slopes: [T; P],
}

/// All measurements as seen from a place, linearised in the first P parameters.
pub(super) struct Sight<T, const P: usize> {
    rows: [Row<T, P>; MOST],
    count: usize,
    /// Prior mean and standard deviation of the level at the reference distance, dB.
    pub(super) level: [T; 2],
    /// ln of the reference distance (m).
    reference: T,
}

impl<T: Scalar, const P: usize> Sight<T, P> {
    pub(super) fn new(
        prior: Option<LevelPrior<T>>,
        measurements: &[Measurement<T>],
        headings: &[Heading<T>],
        place: [T; 2],
    ) -> Self {
        let (level, reference) = match prior {
            Some(LevelPrior { mean, sigma }) => ([mean, sigma.max(T::EPSILON)], T::ZERO),
            None => {
                ([mean_level(measurements), T::from_f64(LEVEL_DB)], T::from_f64(REFERENCE_M).ln())
            }
        };
        let empty = Row { level: T::ZERO, expected: T::ZERO, slopes: [T::ZERO; P] };
        let mut sight = Self { rows: [empty; MOST], count: 0, level, reference };
        let mut headings = headings.iter();
        for (row, measurement) in sight.rows.iter_mut().zip(measurements) {
            *row = Row::new(measurement, headings.next(), place, level, reference);
            sight.count += 1;
        }
        sight
    }

    pub(super) fn rows(&self) -> &[Row<T, P>] {
        self.rows.get(..self.count).unwrap_or(&self.rows)
    }

    /// The level at one metre, dB, and the exponent, from the first two parameters.
    pub(super) fn named(&self, parameters: &[T; P]) -> [T; 2] {
        let exponent = T::from_f64(EXPONENT[0]) + T::from_f64(EXPONENT[1]) * parameters[1];
        let [mean, sigma] = self.level;
        [mean + sigma * parameters[0] + exponent * decibels(self.reference), exponent]
    }
}

impl<T: Scalar, const P: usize> Row<T, P> {
    fn new(
        measurement: &Measurement<T>,
        heading: Option<&Heading<T>>,
        place: [T; 2],
        [level, sigma]: [T; 2],
        reference: T,
    ) -> Self {
        let [x, y] = measurement.place();
        let sight = [x - place[0], y - place[1], measurement.height()];
        let distance = T::norm(&sight).max(T::EPSILON);
        let falls = decibels(distance.ln() - reference);
        let [east, north, up] = sight.map(|axis| axis / distance);
        let unit = T::from_f64(PATTERN_DB);
        let (fifteen, five) = (unit * T::from_f64(ROOTS[0]), unit * T::from_f64(ROOTS[1]));
        let half = T::HALF;
        let mut pattern = [
            fifteen * east * north,
            fifteen * east * up,
            fifteen * north * up,
            fifteen * half * (east * east - north * north),
        ];
        let mut turned = [T::ZERO; TURNED - PARAMETERS];
        if P > PARAMETERS {
            pattern = pattern.map(|slope| slope * T::from_f64(OWN));
            // Without a heading all gains are equally likely, and zero on average.
            if let Some(heading) = heading {
                let [product, forward_up, right_up, difference] = pattern;
                let [product, difference] = heading.turned_twice([product, difference]);
                let [forward_up, right_up] = heading.turned([forward_up, right_up]);
                let [forward, right] =
                    heading.turned([east, north]).map(|it| it * unit * T::from_f64(ROOT));
                turned = [product, forward_up, right_up, difference, forward, right];
            }
        }
        let first =
            [sigma, -falls * T::from_f64(EXPONENT[1]), five * (up * up * T::from_f64(1.5) - half)];
        let mut slopes = [T::ZERO; P];
        for (slope, value) in slopes.iter_mut().zip(first.into_iter().chain(pattern).chain(turned))
        {
            *slope = value;
        }
        Self {
            level: -measurement.loss(),
            expected: level - falls * T::from_f64(EXPONENT[0]),
            slopes,
        }
    }
}

/// Ten times the decimal logarithm, computed from the natural one.
pub(super) fn decibels<T: Scalar>(logarithm: T) -> T {
    logarithm * T::from_f64(10.0 / core::f64::consts::LN_10)
}

/// Mean received level, dB.
fn mean_level<T: Scalar>(measurements: &[Measurement<T>]) -> T {
    let mut mean = T::ZERO;
    for (index, measurement) in measurements.iter().take(MOST).enumerate() {
        mean += (-measurement.loss() - mean) / T::from_binary(index as i32 + 1, 0);
    }
    mean
}
