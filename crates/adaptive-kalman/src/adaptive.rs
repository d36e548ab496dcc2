use crate::{Error, Learning, MeasurementNoise, ProcessNoise};
use kestirim_kalman::{Gaussian, Innovation, Process, SparseRow};
use kestirim_scalar::Scalar;

/// The adaptive extended Kalman filter of N states and M kinds of scalar measurements, in its safe
/// form: see [`MeasurementNoise`] and [`ProcessNoise`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AdaptiveKalman<T: Scalar, const N: usize, const M: usize> {
    estimate: Gaussian<T, N>,
    /// The estimate after the last prediction, from whose mean eq. 19 measures Δx.
    predicted: Gaussian<T, N>,
    process_noise: ProcessNoise<T, N>,
    /// The noise of each measurement with its learning rule, side by side because both are looked up together.
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    measurements: [(MeasurementNoise<T>, Learning<T>); M],
}

impl<T: Scalar, const N: usize, const M: usize> AdaptiveKalman<T, N, M> {
    /// Starts from an estimate, the process noise and, for each measurement, a variance (in its unit squared)
    /// that is clamped to the limits of its learning rule.
    pub fn new(
        estimate: Gaussian<T, N>,
        process_noise: ProcessNoise<T, N>,
        variances: [T; M],
        measurement_learning: [Learning<T>; M],
    ) -> Self {
        let measurements = core::array::from_fn(|index| {
            let learning = measurement_learning[index];
            (MeasurementNoise::new(learning.limited(variances[index])), learning)
        });
        Self { estimate, predicted: estimate, process_noise, measurements }
    }

    /// The estimate.
    #[inline]
    pub fn estimate(&self) -> &Gaussian<T, N> {
        &self.estimate
    }

    /// The process noise as learnt so far, over one step.
    #[inline]
    pub fn process_noise(&self) -> &ProcessNoise<T, N> {
        &self.process_noise
    }

    /// The noise of each measurement as learnt so far.
    #[inline]
    pub fn measurement_noise(&self) -> [MeasurementNoise<T>; M] {
        self.measurements.map(|(noise, _)| noise)
    }

    /// Begins an epoch: adapts Q to what the updates of the last epoch, if there were any, changed, then predicts by `process`, which
    /// must add no noise of its own.
    ///
    /// # Errors
    /// [`Error::Estimate`]; the filter is untouched.
    #[inline]
    pub fn predict(&mut self, process: &impl Process<T, N>) -> Result<(), Error> {
        let mut noise = self.process_noise;
        // Without a measurement nothing was learnt of it: an update changes a variance.
        if self.estimate.covariance.variances() != self.predicted.covariance.variances() {
            noise.learn(&(self.estimate.mean - self.predicted.mean));
        }
        self.estimate.advance(&WithNoise { process, noise: &noise })?;
        self.process_noise = noise;
        self.predicted = self.estimate;
        Ok(())
    }

    /// Takes in measurement `index` with innovation ν = z − h(x) and row h, and learns its noise.
    ///
    /// # Errors
    /// [`Error::NoSuchMeasurement`] or [`Error::Estimate`]; the filter is untouched.
    #[inline]
    pub fn update<const K: usize>(
        &mut self,
        index: usize,
        row: &SparseRow<T, K>,
        innovation: T,
    ) -> Result<Innovation<T>, Error> {
        let measurement = self.measurements.get_mut(index);
        let (noise, learning) = measurement.ok_or(Error::NoSuchMeasurement)?;
        let weighed = self.estimate.weigh(row, innovation, noise.variance())?;
        let report = self.estimate.correct(&weighed)?;
        noise.learn(learning, &weighed);
        Ok(report)
    }

    /// [`AdaptiveKalman::update`] without learning R, for an epoch whose measurements only just determine the state, so
    /// that every residual is small and carries no information. Q is learnt from the state's change, as from any.
    ///
    /// # Errors
    /// As [`AdaptiveKalman::update`].
    #[inline]
    pub fn update_without_learning<const K: usize>(
        &mut self,
        index: usize,
        row: &SparseRow<T, K>,
        innovation: T,
    ) -> Result<Innovation<T>, Error> {
        let (noise, _) = self.measurements.get(index).ok_or(Error::NoSuchMeasurement)?;
        Ok(self.estimate.update(row, innovation, noise.variance())?)
    }
}

/// A process followed by the addition of the learnt Q.
struct WithNoise<'a, P, T: Scalar, const N: usize> {
    process: &'a P,
    noise: &'a ProcessNoise<T, N>,
}

impl<P: Process<T, N>, T: Scalar, const N: usize> Process<T, N> for WithNoise<'_, P, T, N> {
    #[inline]
    fn advance(&self, estimate: &mut Gaussian<T, N>) {
        self.process.advance(estimate);
        estimate.covariance.add(&self.noise.covariance());
    }
}
