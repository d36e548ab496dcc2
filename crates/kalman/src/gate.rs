//! Gates that reject improbable measurements.

use crate::{Error, Gaussian, Innovation, Weighed};
use kestirim_scalar::Scalar;

/// Decision of a [`Gate`] about a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Verdict {
    /// The measurement agrees with the estimate and is taken in.
    Admit,
    /// The measurement does not agree with the estimate and is left out.
    Reject,
    /// The measurement does not agree, nor did many before it, so the estimate must be wrong: take it in with
    /// [`Gaussian::correct_widened`].
    Recover,
}

/// A gate that rejects measurements whose NIS is above γ, but not indefinitely.
///
/// After `patience` rejections in a row, the next disagreeing measurement is trusted instead of the
/// estimate. A gate belongs to one sensor: good measurements of another one say nothing about its
/// bad ones.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Gate<T> {
    gamma: T,
    patience: u16,
    rejected: u16,
}

impl<T: Scalar> Gate<T> {
    /// A gate that rejects above NIS = `gamma` (25 is 5 σ) and gives in after `patience` rejections in a row.
    pub const fn new(gamma: T, patience: u16) -> Self {
        Self { gamma, patience, rejected: 0 }
    }

    /// γ, the largest NIS that is admitted.
    pub const fn gamma(&self) -> T {
        self.gamma
    }

    /// Number of measurements rejected in a row.
    pub const fn rejected(&self) -> u16 {
        self.rejected
    }

    /// Judges the next measurement and counts rejections.
    #[inline(always)]
    pub fn judge<const N: usize>(&mut self, weighed: &Weighed<T, N>) -> Verdict {
        if !weighed.exceeds(self.gamma) {
            self.rejected = 0;
            return Verdict::Admit;
        }
        if self.rejected < self.patience {
            self.rejected += 1;
            return Verdict::Reject;
        }
        self.rejected = 0;
        Verdict::Recover
    }

    /// Judges a measurement that was weighed against `estimate`, and takes it in unless it is rejected.
    ///
    /// # Errors
    /// As [`Gaussian::correct`]; gate and estimate are untouched.
    #[inline]
    pub fn correct<const N: usize>(
        &mut self,
        estimate: &mut Gaussian<T, N>,
        weighed: &Weighed<T, N>,
    ) -> Result<(Verdict, Innovation<T>), Error> {
        let mut judging = *self;
        let verdict = judging.judge(weighed);
        let innovation = match verdict {
            Verdict::Admit => estimate.correct(weighed)?,
            Verdict::Reject => weighed.report(),
            Verdict::Recover => estimate.correct_widened(weighed, self.gamma)?,
        };
        *self = judging;
        Ok((verdict, innovation))
    }
}

impl<T: Scalar, const N: usize> Gaussian<T, N> {
    /// Takes in a measurement after scaling P until its NIS is `gamma`, for an estimate that has been
    /// found wrong. The reported variance of the innovation is that before the scaling.
    ///
    /// # Errors
    /// As [`Gaussian::correct`].
    #[inline(never)] // Rare, and as large as an update.
    pub fn correct_widened(
        &mut self,
        weighed: &Weighed<T, N>,
        gamma: T,
    ) -> Result<Innovation<T>, Error> {
        // ν²/γ = a·hPhᵀ + R, evaluated in an order that stays within the range of fixed point.
        let wanted = weighed.innovation().divided_by(gamma.divisor()) * weighed.innovation();
        let factor = ((wanted - weighed.noise()) / weighed.spread()).max(T::ONE);
        let mut next = *self;
        next.covariance.scale(factor);
        // Before the update, which would move an entry of fixed point off its rail.
        if !(factor.is_finite() && next.covariance.is_finite()) {
            return Err(Error::NotFinite);
        }
        next.correct(&weighed.scaled(factor)?)?;
        *self = next;
        Ok(weighed.report())
    }
}
