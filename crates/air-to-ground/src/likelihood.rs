use crate::Measurement;

/// The likelihood of a measurement, as a filter needs it of a channel.
pub trait Likelihood<T> {
    /// Logarithm of the density (per dB) of what was measured if the user (m, in the plane of the measurements)
    /// is there. It may lack a constant.
    fn log_likelihood(&self, measurement: &Measurement<T>, user: [T; 2]) -> T;
}
