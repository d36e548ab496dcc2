use crate::Measurement;

/// The likelihood of a measurement under a channel, for a filter.
pub trait Likelihood<T> {
    /// Whether [`Likelihood::log_likelihood_again`] is less work than [`Likelihood::log_likelihood`]; only then does a filter
    /// have code for both.
    const IS_LESS_AGAIN: bool = false;

    /// Logarithm of the density (per dB) of the measurement if the user is at `user` (m, in the plane of the
    /// measurements), up to a constant.
    fn log_likelihood(&self, measurement: &Measurement<T>, user: [T; 2]) -> T;

    /// [`Likelihood::log_likelihood`] for a place that another measurement has shown to be possible: what depends on the
    /// place alone, such as the border of an area, need not be looked at again.
    #[inline(always)]
    fn log_likelihood_again(&self, measurement: &Measurement<T>, user: [T; 2]) -> T {
        self.log_likelihood(measurement, user)
    }
}
