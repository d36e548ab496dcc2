use kestirim_scalar::Scalar;

use super::{EXPONENT, LEVEL_DB, MOST, Pattern, REFERENCE_M};
use crate::{Heading, LevelPrior, Measurement};

/// Spread of a coefficient of the pattern, dB.
pub(super) const PATTERN_DB: f64 = 2.0;
/// The same where transmitter and drone have coefficients of their own, in units of that: one dipole's, 3.2 dB in five, is less than two's.
const OWN: f64 = 0.75;
/// √3: it makes harmonics of degree 1 whose mean square over all directions is one.
const ROOT: f64 = 1.732_050_807_568_877_2;
/// √15, √5: they make harmonics whose mean square over all directions is one.
const ROOTS: [f64; 2] = [3.872_983_346_207_417, 2.236_067_977_499_79];

/// Parameters that are fitted: level, exponent and five coefficients of the pattern, all in units of their spread.
pub(super) const PARAMETERS: usize = 7;
/// With those of a pattern that turns with the drone: four of degree 2 that differ from the former, and two of degree 1.
pub(super) const TURNED: usize = 13;

/// How many of them a pattern has, from the first on.
pub(super) fn used(pattern: Pattern) -> usize {
    match pattern {
        Pattern::Isotropic => 2,
        Pattern::Upright => 3,
        Pattern::Tilted => PARAMETERS,
        Pattern::Turned => TURNED,
    }
}

/// Mean square of a pattern's gain by its prior, in units of the square of [`PATTERN_DB`].
pub(super) fn mean_square<T: Scalar>(pattern: Pattern) -> T {
    match pattern {
        Pattern::Isotropic => T::ZERO,
        Pattern::Upright => T::ONE,
        Pattern::Tilted => T::from_f64(5.0),
        Pattern::Turned => T::from_f64(1.0 + 8.0 * OWN * OWN + 2.0),
    }
}

/// A measurement as it is seen from a place.
#[derive(Clone, Copy)]
pub(super) struct Row<T, const P: usize> {
    /// What was received, dB.
    pub(super) level: T,
    /// What is expected before anything is fitted, dB.
    pub(super) expected: T,
    /// By how much a unit of each parameter changes that, dB.
    pub(super) slopes: [T; P],
}

/// All measurements as they are seen from a place: what they say of the first P parameters.
pub(super) struct Sight<T, const P: usize> {
    rows: [Row<T, P>; MOST],
    count: usize,
    /// The level that is expected at the reference, and its standard deviation, dB.
    pub(super) level: [T; 2],
    /// ln of the distance that the level is meant at, m.
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

    /// The level at one metre, dB, and the exponent that the first parameters stand for.
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
            // With no heading all gains are as likely, which is zero on average.
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

/// Ten times the decimal logarithm, from the natural one.
pub(super) fn decibels<T: Scalar>(logarithm: T) -> T {
    logarithm * T::from_f64(10.0 / core::f64::consts::LN_10)
}

/// Mean of what was received, dB.
fn mean_level<T: Scalar>(measurements: &[Measurement<T>]) -> T {
    let mut mean = T::ZERO;
    for (index, measurement) in measurements.iter().take(MOST).enumerate() {
        mean += (-measurement.loss() - mean) / T::from_binary(index as i32 + 1, 0);
    }
    mean
}
