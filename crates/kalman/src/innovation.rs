use crate::Error;
use kestirim_scalar::Scalar;

/// Innovation of a scalar measurement: its difference from what was expected.
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

/// The scalars by which a measurement is weighed, kept apart from the vectors so that they fit into registers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Weights<T: Scalar> {
    pub(crate) innovation: T,
    /// h P hᵀ, the variance of the expected measurement.
    spread: T,
    /// R, the variance of the measurement's noise.
    noise: T,
    /// S = h P hᵀ + R, as the divisor of the gain and the NIS.
    divisor: T::Divisor,
}

impl<T: Scalar> Weights<T> {
    #[inline(always)]
    pub(crate) fn new(innovation: T, spread: T, noise: T) -> Result<Self, Error> {
        if innovation.is_finite() {
            Self::for_update(innovation, spread, noise)
        } else {
            Err(Error::NotFinite)
        }
    }

    /// [`Weights::new`] for an update that moves the mean at once, where an infinite innovation shows in the mean and
    /// is caught.
    #[inline(always)]
    pub(crate) fn for_update(innovation: T, spread: T, noise: T) -> Result<Self, Error> {
        if !(T::IS_FLOAT || innovation.is_finite()) {
            return Err(Error::NotFinite);
        }
        // Rounding can leave h P hᵀ slightly below zero.
        let spread = spread.max(T::ZERO);
        let divisor = checked_divisor(spread, noise)?;
        Ok(Self { innovation, spread, noise, divisor })
    }

    #[inline(always)]
    pub(crate) fn variance(&self) -> T {
        self.spread + self.noise
    }

    #[inline(always)]
    pub(crate) fn by_variance(&self, value: T) -> T {
        value.divided_by(self.divisor)
    }

    #[inline(always)]
    pub(crate) fn report(&self) -> Innovation<T> {
        Innovation {
            innovation: self.innovation,
            variance: self.variance(),
            nis: self.by_variance(self.innovation) * self.innovation,
        }
    }
}

/// A measurement weighed against an estimate that it has not changed yet.
///
/// Gates and robust weights look at it, may change its noise, and take it in with
/// [`Gaussian::correct`](crate::Gaussian::correct) or drop it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weighed<T: Scalar, const N: usize> {
    pub(crate) weights: Weights<T>,
    /// P hᵀ, the covariance of the state with the expected measurement.
    pub(crate) cross: [T; N],
}

impl<T: Scalar, const N: usize> Weighed<T, N> {
    /// The same measurement with another noise variance R.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::NotPositive`].
    #[inline(always)]
    pub fn with_noise(self, noise: T) -> Result<Self, Error> {
        let divisor = checked_divisor(self.weights.spread, noise)?;
        Ok(Self { weights: Weights { noise, divisor, ..self.weights }, ..self })
    }

    /// ν = z − h(x), the innovation.
    #[inline(always)]
    pub fn innovation(&self) -> T {
        self.weights.innovation
    }

    /// h P hᵀ, the variance of the expected measurement.
    #[inline(always)]
    pub fn spread(&self) -> T {
        self.weights.spread
    }

    /// R, the variance of the measurement's noise.
    #[inline(always)]
    pub fn noise(&self) -> T {
        self.weights.noise
    }

    /// S = h P hᵀ + R, the variance of the innovation.
    #[inline(always)]
    pub fn variance(&self) -> T {
        self.weights.variance()
    }

    /// `value / S`, by the divisor that all quotients share.
    #[inline(always)]
    pub fn by_variance(&self, value: T) -> T {
        self.weights.by_variance(value)
    }

    /// P hᵀ, from which the gain P hᵀ/S is computed.
    #[inline(always)]
    pub fn cross_covariance(&self) -> &[T; N] {
        &self.cross
    }

    /// Whether ν² > γ·S, that is NIS > γ, however large ν is.
    #[inline(always)]
    pub fn exceeds(&self, gamma: T) -> bool {
        let square = T::mac(T::accumulator(), self.innovation(), self.innovation());
        T::finish(T::mac(square, -gamma, self.variance())) > T::ZERO
    }

    /// The same measurement weighed against a·P instead of P.
    #[inline(always)]
    pub(crate) fn scaled(&self, a: T) -> Result<Self, Error> {
        let weights = Weights::new(self.innovation(), a * self.spread(), self.noise())?;
        Ok(Self { weights, cross: self.cross.map(|cross| a * cross) })
    }

    /// ν, S and NIS as before the update.
    #[inline(always)]
    pub fn report(&self) -> Innovation<T> {
        self.weights.report()
    }
}

/// S as a divisor, provided that it is positive and finite.
#[inline(always)]
fn checked_divisor<T: Scalar>(spread: T, noise: T) -> Result<T::Divisor, Error> {
    let variance = spread + noise;
    if noise < T::ZERO || !variance.is_positive() {
        return Err(if variance.is_finite() { Error::NotPositive } else { Error::NotFinite });
    }
    Ok(variance.divisor())
}
