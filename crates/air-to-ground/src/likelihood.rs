use crate::Measurement;

/// The likelihood of a measurement under a channel, for a filter.
pub trait Likelihood<T> {
    /// Logarithm of the density (per dB) of the measurement if the user is at `user` (m, in the plane of the
    /// measurements), up to a constant.
    fn log_likelihood(&self, measurement: &Measurement<T>, user: [T; 2]) -> T;
}
