use kestirim_air_to_ground::{Likelihood as Channel, Measurement};
use kestirim_particle_filter::Likelihood;
use kestirim_scalar::Scalar;

/// A measurement through a channel, as a likelihood of states whose first two coordinates are the place. The third
/// one, if there are three, is the amount (dB) by which the transmitter is weaker than the measurement assumes.
pub(crate) struct Seen<'a, T, C> {
    pub(crate) channel: &'a C,
    pub(crate) measurement: &'a Measurement<T>,
}

impl<T: Scalar, C: Channel<T>, const D: usize> Likelihood<T, D> for Seen<'_, T, C> {
    #[inline(always)]
    fn logarithm(&self, state: [T; D]) -> T {
        const { assert!(D >= 2, "a place in the plane") };
        let place = [state[0], state[1]];
        match state.get(2) {
            Some(&level) if D == 3 => {
                self.channel.log_likelihood(&self.measurement.less(level), place)
            }
            _ => self.channel.log_likelihood(self.measurement, place),
        }
    }
}
