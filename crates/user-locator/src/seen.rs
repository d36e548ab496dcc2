use kestirim_air_to_ground::{Likelihood as Channel, Measurement};
use kestirim_particle_filter::Likelihood;
use kestirim_scalar::Scalar;

/// A measurement through a channel, as a likelihood of states whose first two coordinates are the place. The third
/// one, if there are three, is the amount (dB) by which the transmitter is weaker than the measurement assumes.
pub(crate) struct Seen<'a, T, C> {
    pub(crate) channel: &'a C,
    pub(crate) measurement: &'a Measurement<T>,
}

impl<T: Scalar, C> Seen<'_, T, C> {
    /// The measurement as of a transmitter with the level of a state, and the place of the state.
    #[inline(always)]
    fn of<const D: usize>(&self, state: [T; D]) -> (Measurement<T>, [T; 2]) {
        const { assert!(D >= 2, "a place in the plane") };
        let measurement = match state.get(2) {
            Some(&level) if D == 3 => self.measurement.less(level),
            _ => *self.measurement,
        };
        (measurement, [state[0], state[1]])
    }
}

impl<T: Scalar, C: Channel<T>, const D: usize> Likelihood<T, D> for Seen<'_, T, C> {
    #[inline(always)]
    fn logarithm(&self, state: [T; D]) -> T {
        let (measurement, place) = self.of(state);
        self.channel.log_likelihood(&measurement, place)
    }
}

/// A measurement that is not the first one, for states that another one has shown to be possible.
pub(crate) struct SeenAgain<'a, T, C>(pub(crate) Seen<'a, T, C>);

impl<T: Scalar, C: Channel<T>, const D: usize> Likelihood<T, D> for SeenAgain<'_, T, C> {
    #[inline(always)]
    fn logarithm(&self, state: [T; D]) -> T {
        let (measurement, place) = self.0.of(state);
        self.0.channel.log_likelihood_again(&measurement, place)
    }
}
