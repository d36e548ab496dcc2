//! Which measurements are believed.

use crate::{Error, Gaussian, Innovation, Weighed};
use kestirim_scalar::Scalar;

/// What a [`Gate`] made of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Verdict<T> {
    /// It was taken in.
    Taken(Innovation<T>),
    /// It was taken in, after the covariance had been widened: too many had been rejected in a row for
    /// the estimate to be right.
    Recovered(Innovation<T>),
    /// It was left out.
    Rejected(Innovation<T>),
}

impl<T: Scalar> Verdict<T> {
    /// Innovation, its variance and the NIS, before any widening.
    pub fn innovation(&self) -> &Innovation<T> {
        let (Self::Taken(innovation) | Self::Recovered(innovation) | Self::Rejected(innovation)) =
            self;
        innovation
    }

    /// Whether the measurement changed the estimate.
    pub fn is_taken(&self) -> bool {
        !matches!(self, Self::Rejected(_))
    }
}

/// Rejects measurements whose NIS is above γ, but never for ever.
///
/// When more than `patience` measurements in a row are rejected, the estimate is taken to be wrong
/// and not they: P is scaled until the NIS of the next one is γ, and it is taken in. A gate belongs
/// to one sensor: another one's good measurements say nothing about its bad ones.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Gate<T> {
    gamma: T,
    patience: u16,
    rejected: u16,
}

impl<T: Scalar> Gate<T> {
    /// A gate at NIS = `gamma` (25 is 5 σ) that gives up after `patience` rejections in a row.
    pub const fn new(gamma: T, patience: u16) -> Self {
        Self { gamma, patience, rejected: 0 }
    }

    /// How many measurements in a row were rejected.
    pub const fn rejected(&self) -> u16 {
        self.rejected
    }

    /// Takes in a measurement that was weighed against `estimate`, or leaves it out.
    ///
    /// # Errors
    /// As [`Gaussian::correct`]; gate and estimate are untouched.
    #[inline]
    pub fn correct<const N: usize>(
        &mut self,
        estimate: &mut Gaussian<T, N>,
        weighed: &Weighed<T, N>,
    ) -> Result<Verdict<T>, Error> {
        if !weighed.exceeds(self.gamma) {
            let innovation = estimate.correct(weighed)?;
            self.rejected = 0;
            return Ok(Verdict::Taken(innovation));
        }
        let seen = weighed.report(weighed.variance().divisor());
        if self.rejected < self.patience {
            self.rejected += 1;
            return Ok(Verdict::Rejected(seen));
        }
        estimate.correct_widened(weighed, self.gamma)?;
        self.rejected = 0;
        Ok(Verdict::Recovered(seen))
    }
}

impl<T: Scalar, const N: usize> Gaussian<T, N> {
    /// Scales P until the NIS of `weighed` is `gamma`, and takes it in.
    fn correct_widened(&mut self, weighed: &Weighed<T, N>, gamma: T) -> Result<(), Error> {
        // ν²/γ = a·hPhᵀ + R, in an order in which fixed point keeps its range.
        let wanted = weighed.innovation().divided_by(gamma.divisor()) * weighed.innovation();
        let factor = (wanted - weighed.noise()) / weighed.spread();
        if !factor.is_finite() {
            return Err(Error::NotFinite);
        }
        let mut next = *self;
        next.covariance.scale(factor.max(T::ONE));
        next.correct(&weighed.scaled(factor.max(T::ONE)))?;
        if !next.covariance.is_finite() {
            return Err(Error::NotFinite);
        }
        *self = next;
        Ok(())
    }
}
