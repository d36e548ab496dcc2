use crate::Learning;
use kestirim_kalman::Weighed;
use kestirim_scalar::Scalar;

/// The noise variance R of one scalar measurement, learnt from its residuals.
///
/// R ← α R + (1 − α)(ε² + h P⁺ hᵀ), within limits, where ε is the residual after
/// the update: the residual form of eq. 18 (Mohamed and Schwarz 1999), a sum of squares, which
/// cannot become negative. For a scalar update ε = ν R/S and h P⁺ hᵀ = h P⁻ hᵀ R/S, so nothing is
/// evaluated twice.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MeasurementNoise<T> {
    variance: T,
}

impl<T: Scalar> MeasurementNoise<T> {
    /// Starts from a variance, in the measurement's unit squared. The learning rule is passed to each call, so that
    /// many sensors can share one [`Learning`].
    #[inline]
    pub const fn new(variance: T) -> Self {
        Self { variance }
    }

    /// R, the variance learnt so far, in the measurement's unit squared.
    #[inline]
    pub const fn variance(&self) -> T {
        self.variance
    }

    /// Learns from a measurement, before or after it is taken in.
    ///
    /// There is something to learn only where the other measurements alone determine the state:
    /// a measurement that the estimate must follow always fits.
    #[inline]
    pub fn learn<const N: usize>(&mut self, learning: &Learning<T>, weighed: &Weighed<T, N>) {
        self.learn_square(learning, weighed, weighed.innovation() * weighed.innovation());
    }

    /// [`MeasurementNoise::learn`] with `square` in place of ν². For a measurement that a gate rejected,
    /// pass γ S: a single outlier then changes little, and many in a row lead to the same result in the end.
    #[inline(always)]
    pub fn learn_square<const N: usize>(
        &mut self,
        learning: &Learning<T>,
        weighed: &Weighed<T, N>,
        square: T,
    ) {
        let share = weighed.by_variance(weighed.noise());
        let sample = T::mac(T::accumulator(), square * share, share);
        let sample = T::finish(T::mac(sample, weighed.spread(), share));
        self.variance = learning.learn(self.variance, sample);
    }
}
