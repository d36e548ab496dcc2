use crate::Learning;
use kestirim_kalman::Weighed;
use kestirim_scalar::Scalar;

/// The noise variance R of one scalar measurement, learnt from its residuals.
///
/// R ← α R + (1 − α)(ε² + h P⁺ hᵀ), within limits, where ε is what is left of the innovation after
/// the update: the residual form of eq. 18 (Mohamed and Schwarz 1999), a sum of squares, which
/// cannot turn negative. For a scalar update ε = ν R/S and h P⁺ hᵀ = h P⁻ hᵀ R/S: nothing is
/// evaluated twice.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MeasurementNoise<T> {
    variance: T,
    learning: Learning<T>,
}

impl<T: Scalar> MeasurementNoise<T> {
    /// A variance to start from, moved into its limits.
    pub fn new(variance: T, learning: Learning<T>) -> Self {
        Self { variance: learning.limited(variance), learning }
    }

    /// R, in the measurement's unit squared.
    #[inline]
    pub fn variance(&self) -> T {
        self.variance
    }

    /// Learns from a measurement that is about to be taken in, or was.
    ///
    /// Only where the other measurements alone determine the state is there anything to learn from:
    /// a measurement that the estimate must follow always fits it.
    #[inline]
    pub fn learn<const N: usize>(&mut self, weighed: &Weighed<T, N>) {
        let square = weighed.innovation() * weighed.innovation();
        self.variance = learnt(self.variance, &self.learning, weighed, square);
    }
}

/// [`MeasurementNoise::learn`] for who keeps variances and learning apart: the variance after one more
/// measurement, of whose ν² only `square` is believed. Where a gate left it out, γ S is enough: one wild
/// value then teaches little, and many in a row the same in the end.
#[inline(always)]
pub fn learnt<T: Scalar, const N: usize>(
    variance: T,
    learning: &Learning<T>,
    weighed: &Weighed<T, N>,
    square: T,
) -> T {
    let share = weighed.by_variance(weighed.noise());
    let sample = T::mac(T::accumulator(), square * share, share);
    learning.learn(variance, T::finish(T::mac(sample, weighed.spread(), share)))
}
