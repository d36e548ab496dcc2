use kestirim_scalar::Scalar;

use crate::{Channel, Error, Likelihood, Measurement};

/// A channel of which some measurements say nothing: a robust likelihood.
///
/// A share ε of them is taken to be anything within 100 dB, so that a single wild measurement costs no more
/// than ln(100/ε) however far it is from all that the channel expects.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Contaminated<T> {
    channel: Channel<T>,
    /// ln(1 − ε) and ln(ε/100 dB).
    log_good: T,
    log_bad: T,
}

impl<T: Scalar> Contaminated<T> {
    /// A channel with this share of bad measurements, between 0 and 1.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::NotPositive`] if it is not between them.
    #[inline]
    pub fn new(channel: Channel<T>, share: T) -> Result<Self, Error> {
        if !share.is_finite() {
            return Err(Error::NotFinite);
        }
        if share <= T::ZERO || share >= T::ONE {
            return Err(Error::NotPositive);
        }
        let log_bad = share.ln() - T::from_f64(4.605_170_185_988_092);
        Ok(Self { channel, log_good: (T::ONE - share).ln(), log_bad })
    }
}

impl<T: Scalar> Likelihood<T> for Contaminated<T> {
    #[inline(always)]
    fn log_likelihood(&self, measurement: &Measurement<T>, user: [T; 2]) -> T {
        let good = self.channel.log_likelihood(measurement, user) + self.log_good;
        let bad = self.log_bad;
        let (larger, apart) = if good > bad { (good, bad - good) } else { (bad, good - bad) };
        larger + (T::ONE + apart.exp()).ln()
    }
}
