//! Sines and cosines of angles in rad, all through `sincos`: separate `sin` and `cos` would add 2.4 kB of flash to the
//! image of a positioning filter.

/// The sine of an angle, rad.
pub(crate) fn sin(angle: f64) -> f64 {
    libm::sincos(angle).0
}

/// The cosine of an angle, rad.
pub(crate) fn cos(angle: f64) -> f64 {
    libm::sincos(angle).1
}

/// The sine and cosine of an angle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn {
    pub(crate) sine: f64,
    pub(crate) cosine: f64,
}

impl Turn {
    /// The zero angle.
    pub(crate) const NONE: Self = Self { sine: 0.0, cosine: 1.0 };

    /// Computes the sine and cosine of an angle, rad.
    pub(crate) fn of(angle: f64) -> Self {
        let (sine, cosine) = libm::sincos(angle);
        Self { sine, cosine }
    }

    /// The sum of two angles.
    #[inline(never)] // Wanted at several places, once in flash.
    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            sine: self.sine * other.cosine + self.cosine * other.sine,
            cosine: self.cosine * other.cosine - self.sine * other.sine,
        }
    }

    /// The sum of small multiples of angles: faster than a sine of the sum.
    #[inline(never)] // Wanted at several places, once in flash.
    pub(crate) fn sum(multiples: &[i8], angles: &[Self]) -> Self {
        let mut sum = Self::NONE;
        for (multiple, angle) in multiples.iter().zip(angles) {
            let sine = if *multiple < 0 { -angle.sine } else { angle.sine };
            let once = Self { sine, ..*angle };
            for _ in 0..multiple.unsigned_abs() {
                sum = sum.plus(once);
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::Turn;

    #[test]
    fn sums_of_multiples() {
        let angles = [0.3, -2.9, 1.1, 6.0];
        let turns = angles.map(Turn::of);
        for multiples in [[0, 0, 0, 0], [2, -1, 0, 1], [4, 0, -2, 0], [-3, 1, 1, -2]] {
            let angle: f64 = multiples
                .iter()
                .zip(angles)
                .map(|(multiple, angle)| f64::from(*multiple) * angle)
                .sum();
            let sum = Turn::sum(&multiples, &turns);
            assert!((sum.sine - angle.sin()).abs() < 1e-14, "{multiples:?}");
            assert!((sum.cosine - angle.cos()).abs() < 1e-14, "{multiples:?}");
        }
    }
}
