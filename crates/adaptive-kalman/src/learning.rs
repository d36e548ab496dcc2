use crate::Error;
use kestirim_scalar::Scalar;

/// Rule by which a variance is learnt: a forgetting factor, and the limits of the variance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Learning<T> {
    forgetting: T,
    least: T,
    most: T,
}

impl<T: Scalar> Learning<T> {
    /// The rule v ← α v + (1 − α) sample, kept within `least..=most`.
    ///
    /// α = 0.95 remembers about 20 samples; 1 learns nothing.
    ///
    /// # Errors
    /// [`Error::InvalidLearning`] unless 0 ≤ α ≤ 1 and 0 ≤ `least` ≤ `most`, all finite.
    pub fn new(forgetting: T, least: T, most: T) -> Result<Self, Error> {
        let unit = T::ZERO <= forgetting && forgetting <= T::ONE;
        let ordered = T::ZERO <= least && least <= most && most.is_finite();
        if unit && ordered {
            Ok(Self { forgetting, least, most })
        } else {
            Err(Error::InvalidLearning)
        }
    }

    /// The same rule with both limits `factor` times as large.
    #[inline]
    #[must_use]
    pub fn raised(&self, factor: T) -> Self {
        Self { least: self.least * factor, most: self.most * factor, ..*self }
    }

    /// The variance after one more sample. Samples are clamped to the largest variance, so that a square that
    /// overflows does no harm.
    #[inline(always)]
    pub fn learn(&self, variance: T, sample: T) -> T {
        let sample = sample.min(self.most);
        let sum = T::mac(T::accumulator(), self.forgetting, variance);
        T::finish(T::mac(sum, T::ONE - self.forgetting, sample)).max(self.least)
    }

    /// The variance clamped to the limits.
    #[inline]
    pub fn limited(&self, variance: T) -> T {
        variance.clamp(self.least, self.most)
    }
}
