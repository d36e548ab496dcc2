use crate::innovation::Weights;
use crate::{Covariance, Error, Innovation, Linear, Observation, Process, SparseRow, Weighed};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// Number of states from which on P is traversed by columns, most of which are then long: fewer bounds checks, same
/// sums.
pub(crate) const MANY: usize = 17;

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
    /// x, the mean.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "finite"))]
    pub mean: SVector<T, N>,
    /// P, the covariance of the mean's error.
    pub covariance: Covariance<T, N>,
}

/// Deserialises a mean, all of whose entries must be finite.
#[cfg(feature = "serde")]
fn finite<'de, D, T, const N: usize>(deserializer: D) -> Result<SVector<T, N>, D::Error>
where
    D: serde::Deserializer<'de>,
    T: Scalar + serde::Deserialize<'de>,
{
    let mean = <SVector<T, N> as serde::Deserialize>::deserialize(deserializer)?;
    if T::all_finite(mean.as_array()) {
        Ok(mean)
    } else {
        Err(serde::de::Error::custom("an estimate that is not finite"))
    }
}

impl<T: Scalar, const N: usize> Gaussian<T, N> {
    /// An estimate from its mean and covariance.
    #[inline]
    pub const fn new(mean: SVector<T, N>, covariance: Covariance<T, N>) -> Self {
        Self { mean, covariance }
    }

    /// x ← F x, P ← F P Fᵀ + Q (Kalman 1960).
    ///
    /// For a sparse F, [`Covariance::shear`] costs a fraction: see [`Process`].
    ///
    /// # Errors
    /// [`Error::NotFinite`] if F or Q is not finite or the estimate would become so; [`Error::NotPositive`] if a variance of Q
    /// is negative. The estimate is untouched.
    #[inline]
    pub fn predict(&mut self, f: &SMatrix<T, N, N>, q: &Covariance<T, N>) -> Result<(), Error> {
        if !(q.is_finite() && T::all_finite(f.as_columns().as_flattened())) {
            return Err(Error::NotFinite);
        }
        if q.variances().as_array().iter().any(|&variance| variance < T::ZERO) {
            return Err(Error::NotPositive);
        }
        self.advance(&Linear { f, q })
    }

    /// Predicts the estimate by any process, linear or linearised.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if the estimate would become so; it is untouched.
    #[inline(always)]
    pub fn advance(&mut self, process: &impl Process<T, N>) -> Result<(), Error> {
        let mut next = *self;
        process.advance(&mut next);
        next.covariance.absorb_rounding();
        // No covariance exceeds √(P[i, i]·P[j, j]), so finite variances suffice.
        if !(T::all_finite(next.mean.as_array()) && next.covariance.has_finite_variances()) {
            return Err(Error::NotFinite);
        }
        *self = next;
        Ok(())
    }

    /// Adds process noise to one state (unit: the state's, squared).
    ///
    /// # Errors
    /// [`Error::IndexOutOfRange`], [`Error::NotPositive`] for a negative variance, or
    /// [`Error::NotFinite`]; the estimate is untouched.
    #[inline]
    pub fn add_variance_at(&mut self, index: usize, variance: T) -> Result<(), Error> {
        if index >= N {
            return Err(Error::IndexOutOfRange);
        }
        if variance < T::ZERO {
            return Err(Error::NotPositive);
        }
        let entry = self.covariance.entry(index, index);
        let sum = *entry + variance;
        if !sum.is_finite() {
            return Err(Error::NotFinite);
        }
        *entry = sum;
        Ok(())
    }

    /// Resets one state: sets its mean and variance, and its covariances with the others to zero.
    ///
    /// # Errors
    /// [`Error::IndexOutOfRange`], [`Error::NotPositive`] for a negative variance, or
    /// [`Error::NotFinite`]; the estimate is untouched.
    pub fn reset_at(&mut self, index: usize, mean: T, variance: T) -> Result<(), Error> {
        if index >= N {
            return Err(Error::IndexOutOfRange);
        }
        if variance < T::ZERO {
            return Err(Error::NotPositive);
        }
        if !(mean.is_finite() && variance.is_finite()) {
            return Err(Error::NotFinite);
        }
        self.mean.as_array_mut()[index] = mean;
        for other in 0..N {
            *self.covariance.entry(index, other) = T::ZERO;
        }
        *self.covariance.entry(index, index) = variance;
        Ok(())
    }

    /// Takes in a measurement of noise variance R by its model, linear or not.
    ///
    /// # Errors
    /// As [`Gaussian::weigh_observation`]; the estimate is untouched.
    #[inline]
    pub fn observe(
        &mut self,
        observation: &impl Observation<T, N>,
        variance: T,
    ) -> Result<Innovation<T>, Error> {
        let weighed = self.weigh_observation(observation, variance)?;
        self.correct(&weighed)
    }

    /// Weighs a measurement of noise variance R by its model, without changing the estimate.
    ///
    /// # Errors
    /// As [`Observation::linearise`] and [`Gaussian::update`].
    #[inline(always)]
    pub fn weigh_observation(
        &self,
        observation: &impl Observation<T, N>,
        variance: T,
    ) -> Result<Weighed<T, N>, Error> {
        let (innovation, row) = observation.linearise(&self.mean)?;
        self.weigh_entries(row.as_ref(), innovation, variance)
    }

    /// Takes in one scalar measurement with innovation ν = z − h(x), sparse row h = ∂h/∂x and variance R.
    ///
    /// S = h P hᵀ + R, k = P hᵀ/S, x ← x + k ν, P ← P − k h P. Several independent measurements
    /// are taken in one after the other: one division each and no matrix inverse. The innovation
    /// comes from the caller, which serves linear and linearised models alike
    /// ([`SparseRow::dot`] helps with linear ones, [`Gaussian::observe`] with both).
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::NotPositive`] (R or, in fixed point, a variance after the update) or
    /// [`Error::IndexOutOfRange`]; the estimate is untouched.
    #[inline]
    pub fn update<const K: usize>(
        &mut self,
        row: &SparseRow<T, K>,
        innovation: T,
        variance: T,
    ) -> Result<Innovation<T>, Error> {
        let row = row.entries();
        Self::covers(row)?;
        let cross = self.cross_covariance(row);
        let weights = Weights::for_update(innovation, spread(row, &cross), variance)?;
        self.take_in(&weights, &cross)
    }

    /// Weighs a measurement as [`Gaussian::update`] would, without changing the estimate.
    ///
    /// # Errors
    /// As [`Gaussian::update`].
    #[inline(always)]
    pub fn weigh<const K: usize>(
        &self,
        row: &SparseRow<T, K>,
        innovation: T,
        variance: T,
    ) -> Result<Weighed<T, N>, Error> {
        self.weigh_entries(row.entries(), innovation, variance)
    }

    /// [`Gaussian::weigh`] for a row whose number of entries is known only at run time: pairs of a
    /// state's index and ∂h/∂(that state).
    ///
    /// # Errors
    /// As [`Gaussian::update`].
    #[inline(always)] // With literal indices, the look-up vanishes.
    pub fn weigh_entries(
        &self,
        row: &[(usize, T)],
        innovation: T,
        variance: T,
    ) -> Result<Weighed<T, N>, Error> {
        Self::covers(row)?;
        let cross = self.cross_covariance(row);
        let weights = Weights::new(innovation, spread(row, &cross), variance)?;
        Ok(Weighed { weights, cross })
    }

    /// Takes in a measurement that was weighed against exactly this estimate.
    ///
    /// # Errors
    /// [`Error::NotFinite`], and in fixed point [`Error::NotPositive`]; the estimate is untouched.
    #[inline(always)]
    pub fn correct(&mut self, weighed: &Weighed<T, N>) -> Result<Innovation<T>, Error> {
        self.take_in(&weighed.weights, &weighed.cross)
    }

    /// Takes in a scalar measurement of state `I` itself: [`Gaussian::update`] with a unit row.
    ///
    /// The row and column of the measured state are scaled by R/S instead of being subtracted
    /// from: N multiplications less.
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
        Ok(self.update_at(I, innovation, variance)?.report())
    }

    /// [`Gaussian::update_component`] for an index known to be below N.
    ///
    /// Compiled for speed, each index has instructions of its own; compiled for size, all share one function.
    #[cfg_attr(for_size, inline(never))]
    #[cfg_attr(not(for_size), inline(always))]
    fn update_at(&mut self, index: usize, innovation: T, variance: T) -> Result<Weights<T>, Error> {
        let weights =
            Weights::for_update(innovation, self.covariance.known(index, index), variance)?;
        let cross = core::array::from_fn(|other| self.covariance.known(index, other));
        let (mut gain, mut left) = ([T::ZERO; N], [T::ZERO; N]);
        self.move_mean(&weights, &cross, &mut gain, &mut left)?;
        self.covariance.downdate_beside(index, &gain, &cross, &left);
        self.covariance.scale_component(index, weights.by_variance(variance));
        Ok(weights)
    }

    /// Refuses a row that names a state beyond N.
    #[inline(always)]
    fn covers(row: &[(usize, T)]) -> Result<(), Error> {
        if row.iter().all(|&(index, _)| index < N) { Ok(()) } else { Err(Error::IndexOutOfRange) }
    }

    /// P hᵀ for a row whose indices are below N.
    #[inline(always)]
    fn cross_covariance(&self, row: &[(usize, T)]) -> [T; N] {
        if N >= MANY {
            return self.covariance.times(row);
        }
        let mut cross = [T::ZERO; N];
        for (i, cross) in cross.iter_mut().enumerate() {
            let mut sum = T::accumulator();
            for &(index, value) in row {
                sum = T::mac(sum, value, self.covariance.known(index, i));
            }
            *cross = T::finish(sum);
        }
        cross
    }

    /// x ← x + k ν, P ← P − k h P.
    #[inline(always)]
    fn take_in(&mut self, weights: &Weights<T>, cross: &[T; N]) -> Result<Innovation<T>, Error> {
        let (mut gain, mut left) = ([T::ZERO; N], [T::ZERO; N]);
        self.move_mean(weights, cross, &mut gain, &mut left)?;
        self.covariance.downdate(&gain, cross, &left);
        Ok(weights.report())
    }

    /// x ← x + k ν, the gain k, and in fixed point the variances left. (By reference: within a `Result` they would be copied.)
    #[inline(always)]
    fn move_mean(
        &mut self,
        weights: &Weights<T>,
        cross: &[T; N],
        gain: &mut [T; N],
        left: &mut [T; N],
    ) -> Result<(), Error> {
        let mut mean = *self.mean.as_array();
        for i in 0..N {
            gain[i] = weights.by_variance(cross[i]);
            let step = gain[i] * weights.innovation;
            // The mean may lead back from the end of fixed point's range.
            if !(T::IS_FLOAT || step.is_finite()) {
                return Err(Error::NotFinite);
            }
            mean[i] += step;
        }
        // A float's gain that is not finite makes the mean so as well, even where the innovation is zero.
        if !T::all_finite(&mean) {
            return Err(Error::NotFinite);
        }
        self.covariance.variances_left(gain, cross, left)?;
        *self.mean.as_array_mut() = mean;
        Ok(())
    }
}

/// h P hᵀ from the row h and P hᵀ.
#[inline(always)]
fn spread<T: Scalar, const N: usize>(row: &[(usize, T)], cross: &[T; N]) -> T {
    let mut spread = T::accumulator();
    for &(index, value) in row {
        if let Some(&cross) = cross.get(index) {
            spread = T::mac(spread, value, cross);
        }
    }
    T::finish(spread)
}
