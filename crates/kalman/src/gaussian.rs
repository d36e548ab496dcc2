use crate::{Covariance, Error, SparseRow};
use kestirim_scalar::Scalar;
use nalgebra::{SMatrix, SVector};

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

/// A state estimate: mean x and covariance P of N states.
///
/// For an error-state filter the mean is the error, zero between injections.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Gaussian<T: Scalar, const N: usize> {
    /// x, the estimate.
    pub mean: SVector<T, N>,
    /// P, its uncertainty.
    pub covariance: Covariance<T, N>,
}

impl<T: Scalar, const N: usize> Gaussian<T, N> {
    /// An estimate from its mean and covariance.
    #[inline]
    pub const fn new(mean: SVector<T, N>, covariance: Covariance<T, N>) -> Self {
        Self { mean, covariance }
    }

    /// x ← F x, P ← F P Fᵀ + Q (Kalman 1960).
    ///
    /// For a sparse F, [`Covariance::shear`] costs a fraction.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if F or Q is not finite or the estimate would cease to be.
    #[inline]
    pub fn predict(&mut self, f: &SMatrix<T, N, N>, q: &Covariance<T, N>) -> Result<(), Error> {
        let mut mean = SVector::zeros();
        for row in 0..N {
            let mut sum = T::accumulator();
            for column in 0..N {
                sum = T::mac(sum, f.data.0[column][row], self.mean.data.0[0][column]);
            }
            mean.data.0[0][row] = T::finish(sum);
        }
        let mut covariance = self.covariance.transformed(f);
        covariance.add(q);
        if !(is_finite(&mean.data.0[0]) && covariance.is_finite()) {
            return Err(Error::NotFinite);
        }
        *self = Self { mean, covariance };
        Ok(())
    }

    /// One scalar measurement with innovation ν = z − h(x), sparse row h = ∂h/∂x and variance R.
    ///
    /// S = h P hᵀ + R, k = P hᵀ/S, x ← x + k ν, P ← P − k h P. Several independent measurements
    /// are taken one after the other: a division each and no matrix inverse. The innovation
    /// comes from the caller, so a linear and a linearised model are served alike
    /// ([`SparseRow::dot`] helps the linear one).
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::NotPositive`] or [`Error::IndexOutOfRange`]; the estimate is
    /// untouched.
    #[inline]
    pub fn update<const K: usize>(
        &mut self,
        row: &SparseRow<T, K>,
        innovation: T,
        variance: T,
    ) -> Result<Innovation<T>, Error> {
        if row.entries().iter().any(|&(index, _)| index >= N) {
            return Err(Error::IndexOutOfRange);
        }
        let mut g = [T::ZERO; N];
        for (i, g) in g.iter_mut().enumerate() {
            let mut sum = T::accumulator();
            for &(index, value) in row.entries() {
                sum = T::mac(sum, value, self.covariance.at(index, i));
            }
            *g = T::finish(sum);
        }
        let mut spread = T::accumulator();
        for &(index, value) in row.entries() {
            if let Some(&g) = g.get(index) {
                spread = T::mac(spread, value, g);
            }
        }
        let weighed = Weighed::new(innovation, T::finish(spread), variance)?;
        let gain = self.correct(&g, &weighed)?;
        self.covariance.downdate(&gain, &g);
        Ok(weighed.report())
    }

    /// A scalar measurement of state `I` itself: [`Gaussian::update`] with a unit row.
    ///
    /// The row and column of the measured state are scaled by R/S instead of being subtracted
    /// from, which cannot turn its variance negative.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::NotPositive`]; the estimate is untouched.
    #[inline]
    pub fn update_component<const I: usize>(
        &mut self,
        innovation: T,
        variance: T,
    ) -> Result<Innovation<T>, Error> {
        const { assert!(I < N, "the state has no such component") };
        let mut g = [T::ZERO; N];
        for (i, g) in g.iter_mut().enumerate() {
            *g = self.covariance.at(I, i);
        }
        let weighed = Weighed::new(innovation, g[I], variance)?;
        let gain = self.correct(&g, &weighed)?;
        self.covariance.downdate_beside::<I>(&gain, &g);
        self.covariance.scale_component::<I>(weighed.divide(variance));
        Ok(weighed.report())
    }

    /// x ← x + k ν, and the gain k.
    #[inline]
    fn correct(&mut self, g: &[T; N], weighed: &Weighed<T>) -> Result<[T; N], Error> {
        let mut gain = [T::ZERO; N];
        let mut mean = self.mean.data.0[0];
        for i in 0..N {
            gain[i] = weighed.divide(g[i]);
            mean[i] += gain[i] * weighed.innovation;
        }
        // A gain that is not finite makes its mean not finite, even where the innovation is zero.
        if !is_finite(&mean) {
            return Err(Error::NotFinite);
        }
        self.mean.data.0[0] = mean;
        Ok(gain)
    }
}

/// A measurement that passed its checks, with the one reciprocal everything shares.
struct Weighed<T: Scalar> {
    innovation: T,
    variance: T,
    divisor: T::Divisor,
}

impl<T: Scalar> Weighed<T> {
    #[inline]
    fn new(innovation: T, spread: T, noise: T) -> Result<Self, Error> {
        let variance = spread + noise;
        if !(innovation.is_finite() && variance.is_finite()) {
            return Err(Error::NotFinite);
        }
        // Rounding can leave h P hᵀ a trifle below zero; a negative R cannot be meant.
        if noise < T::ZERO || variance <= T::ZERO {
            return Err(Error::NotPositive);
        }
        Ok(Self { innovation, variance, divisor: variance.divisor() })
    }

    #[inline]
    fn divide(&self, value: T) -> T {
        value.divided_by(self.divisor)
    }

    #[inline]
    fn report(&self) -> Innovation<T> {
        Innovation {
            innovation: self.innovation,
            variance: self.variance,
            nis: self.divide(self.innovation) * self.innovation,
        }
    }
}

#[inline]
fn is_finite<T: Scalar>(values: &[T]) -> bool {
    values.iter().all(|value| value.is_finite())
}
