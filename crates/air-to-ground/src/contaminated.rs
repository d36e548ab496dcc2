use kestirim_scalar::Scalar;

use crate::{Channel, Error, Likelihood, Measurement};

/// A channel with a robust likelihood, for measurements of which some carry no information.
///
/// A share ε of the measurements is assumed uniform over 100 dB, so that a single outlier costs no more than
/// ln(100/ε), however far it is from what the channel expects.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Contaminated<T> {
    channel: Channel<T>,
    /// The log-weights ln(1 − ε) of good and ln(ε/100 dB) of bad measurements.
    log_good: T,
    log_bad: T,
}

impl<T: Scalar> Contaminated<T> {
    /// Creates a channel with this share of bad measurements, between 0 and 1.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::NotPositive`] if the share is not between 0 and 1.
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
