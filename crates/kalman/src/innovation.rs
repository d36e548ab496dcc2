use crate::Error;
use kestirim_scalar::Scalar;

/// What a measurement said beyond what was expected.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Innovation<T> {
    /// ν = z − h(x), in the measurement's unit.
    pub innovation: T,
    /// S = h P hᵀ + R, in the measurement's unit squared.
    pub variance: T,
    /// ν²/S, the normalised innovation squared: 1 on average when the model is right.
    pub nis: T,
}

/// A measurement weighed against an estimate that it has not changed yet.
///
/// Gates and robust weights look at it, may change its noise, and take it in with
/// [`Gaussian::correct`](crate::Gaussian::correct) or drop it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Weighed<T, const N: usize> {
    innovation: T,
    /// h P hᵀ.
    spread: T,
    /// R.
    noise: T,
    /// P hᵀ.
    cross: [T; N],
}

impl<T: Scalar, const N: usize> Weighed<T, N> {
    #[inline]
    pub(crate) fn new(innovation: T, spread: T, noise: T, cross: [T; N]) -> Result<Self, Error> {
        if !(innovation.is_finite() && spread.is_finite()) {
            return Err(Error::NotFinite);
        }
        // Rounding can leave h P hᵀ a trifle below zero.
        let spread = spread.max(T::ZERO);
        Self { innovation, spread, noise, cross }.with_noise(noise)
    }

    /// The same measurement with another noise variance R.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::NotPositive`].
    #[inline]
    pub fn with_noise(mut self, noise: T) -> Result<Self, Error> {
        self.noise = noise;
        if !self.variance().is_finite() {
            return Err(Error::NotFinite);
        }
        if noise < T::ZERO || self.variance() <= T::ZERO {
            return Err(Error::NotPositive);
        }
        Ok(self)
    }

    /// ν = z − h(x).
    #[inline]
    pub fn innovation(&self) -> T {
        self.innovation
    }

    /// h P hᵀ: how uncertain the expectation is.
    #[inline]
    pub fn spread(&self) -> T {
        self.spread
    }

    /// R: how uncertain the measurement is.
    #[inline]
    pub fn noise(&self) -> T {
        self.noise
    }

    /// S = h P hᵀ + R.
    #[inline]
    pub fn variance(&self) -> T {
        self.spread + self.noise
    }

    /// P hᵀ, from which the gain P hᵀ/S is made.
    #[inline]
    pub fn cross_covariance(&self) -> &[T; N] {
        &self.cross
    }

    /// Whether ν² > γ·S, that is NIS > γ, without a division and however large ν is.
    #[inline]
    pub fn exceeds(&self, gamma: T) -> bool {
        let square = T::mac(T::accumulator(), self.innovation, self.innovation);
        T::finish(T::mac(square, -gamma, self.variance())) > T::ZERO
    }

    /// The same measurement against a·P.
    #[inline]
    pub(crate) fn scaled(&self, a: T) -> Self {
        let cross = self.cross.map(|cross| a * cross);
        Self { spread: a * self.spread, cross, ..*self }
    }

    /// ν, S and NIS as they are before the update.
    #[inline]
    pub fn innovation_report(&self) -> Innovation<T> {
        self.report(self.variance().divisor())
    }

    #[inline]
    pub(crate) fn report(&self, divisor: T::Divisor) -> Innovation<T> {
        Innovation {
            innovation: self.innovation,
            variance: self.variance(),
            nis: self.innovation.divided_by(divisor) * self.innovation,
        }
    }
}
