use core::fmt;
use nalgebra::Complex;

/// A mode of a linear system: an eigenvalue of its dynamics, and the state that it moves most.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Mode {
    /// Real part of the eigenvalue: in 1/s, or per step in discrete time.
    pub re: f64,
    /// Imaginary part of the eigenvalue.
    pub im: f64,
    /// Index of the state that the mode moves most (on the balanced scale).
    pub state: usize,
}

/// Reason why a design was refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// An argument or the result is NaN or infinite.
    NotFinite,
    /// The interval is not positive.
    Interval,
    /// A complex pole is given without its conjugate, so no real gain can place it.
    NotConjugate,
    /// This mode is unobservable: no output depends on it.
    Unobservable(Mode),
    /// This mode is uncontrollable: no input moves it.
    Uncontrollable(Mode),
    /// This mode neither decays nor is observable.
    Undetectable(Mode),
    /// This mode neither decays nor grows, and no noise drives it: the filter would learn it perfectly,
    /// and no steady gain would remain.
    Undriven(Mode),
    /// This mode does not decay.
    Unstable(Mode),
    /// A covariance is not symmetric.
    NotSymmetric,
    /// A covariance has a negative variance, or the measurement noise is zero in some direction.
    NotPositive,
    /// A matrix that must be inverted is singular.
    Singular,
    /// No gain of double precision can place these poles: with the best one, a pole is off by this fraction.
    IllConditioned(f64),
    /// An iteration did not converge.
    NotConverged,
}

impl fmt::Display for Mode {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = libm::hypot(self.re, self.im);
        write!(formatter, "{}", legible(self.re, size))?;
        if legible(self.im, size) != 0.0 {
            write!(formatter, " ± {}i", legible(self.im, size).abs())?;
        }
        write!(formatter, " (mostly state {})", self.state)
    }
}

/// The value rounded to eight digits of `size`; residues of rounding become zero.
fn legible(value: f64, size: f64) -> f64 {
    if size < 1e-15 {
        return 0.0;
    }
    // Ten to a positive power is exact, but its reciprocal is not.
    let digits = 7.0 - libm::floor(libm::log10(size));
    let power = libm::exp10(digits.abs());
    let rounded = if digits < 0.0 {
        libm::round(value / power) * power
    } else {
        libm::round(value * power) / power
    };
    // Avoids a minus sign before zero.
    rounded + 0.0
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => formatter.write_str("a number is not finite"),
            Self::Interval => formatter.write_str("the interval is not positive"),
            Self::NotConjugate => {
                formatter.write_str("a complex pole stands without its conjugate")
            }
            Self::Unobservable(mode) => write!(formatter, "no output sees the mode {mode}"),
            Self::Uncontrollable(mode) => write!(formatter, "no input moves the mode {mode}"),
            Self::Undetectable(mode) => {
                write!(formatter, "no output sees the mode {mode}, which does not decay")
            }
            Self::Undriven(mode) => {
                write!(formatter, "no noise drives the mode {mode}, which neither decays nor grows")
            }
            Self::Unstable(mode) => write!(formatter, "the mode {mode} does not decay"),
            Self::NotSymmetric => formatter.write_str("a covariance is not symmetric"),
            Self::NotPositive => formatter.write_str("a covariance is not positive"),
            Self::Singular => formatter.write_str("a matrix is singular"),
            Self::IllConditioned(error) => write!(
                formatter,
                "no gain of double precision holds these poles: one would be off by {error:.1e} of itself"
            ),
            Self::NotConverged => formatter.write_str("an iteration did not settle"),
        }
    }
}

impl core::error::Error for Error {}

impl Mode {
    pub(crate) fn new(pole: Complex<f64>, state: usize) -> Self {
        Self { re: pole.re, im: pole.im, state }
    }

    /// Whether this is the same mode found twice, or the other one of a conjugate pair.
    pub(crate) fn is_twin_of(&self, other: &Self) -> bool {
        let distance = libm::hypot(self.re - other.re, self.im.abs() - other.im.abs());
        self.state == other.state && distance <= 1e-6 * libm::hypot(self.re, self.im).max(1e-6)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::collections::BTreeSet;
    use std::string::ToString;

    use super::*;

    const SLOW: Mode = Mode { re: -0.125, im: 1e-12, state: 2 };

    #[test]
    fn modes_are_rounded_to_what_can_be_read() {
        assert_eq!(SLOW.to_string(), "-0.125 (mostly state 2)");
        let fast = Mode { re: -1.0 / 3.0, im: -2.0e9, state: 0 };
        assert_eq!(fast.to_string(), "0 ± 2000000000i (mostly state 0)");
        assert_eq!(Mode { re: 0.0, im: 0.0, state: 1 }.to_string(), "0 (mostly state 1)");
    }

    #[test]
    fn every_reason_is_a_sentence_of_its_own() {
        let all = [
            Error::NotFinite,
            Error::Interval,
            Error::NotConjugate,
            Error::Unobservable(SLOW),
            Error::Uncontrollable(SLOW),
            Error::Undetectable(SLOW),
            Error::Undriven(SLOW),
            Error::Unstable(SLOW),
            Error::NotSymmetric,
            Error::NotPositive,
            Error::Singular,
            Error::IllConditioned(0.25),
            Error::NotConverged,
        ];
        let sentences: BTreeSet<_> = all.iter().map(ToString::to_string).collect();
        assert_eq!(sentences.len(), all.len());
        for sentence in &sentences {
            assert!(sentence.starts_with(char::is_lowercase) && !sentence.ends_with('.'));
            assert!(sentence.len() < 120, "{sentence}");
        }
    }
}
