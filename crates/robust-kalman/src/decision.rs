use kestirim_scalar::Scalar;

/// Reason for the weight of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Reason {
    /// The measurement agrees with the others and the prediction: full weight.
    Agrees,
    /// No other measurement checks it, as of the first phase of a satellite: full weight, not
    /// judged.
    NoRedundancy,
    /// Fewer than the three measurements that a t-test needs: full weight, not judged.
    TooFew,
    /// Between the two thresholds, or beyond Huber's: less weight.
    DownWeighted,
    /// The residual is beyond the outer threshold: no weight.
    Rejected,
}

/// Decision about one measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Decision<T> {
    /// γ in 0..=1, by which R was divided; 0 left the measurement out.
    pub weight: T,
    /// Reason for the weight.
    pub reason: Reason,
    /// v = z − h(x⁺) after the whole update, in the measurement's unit.
    pub residual: T,
    /// ṽ = v / (σ̂0 √Qᵥ) when it was judged; 0 if it was not.
    pub standardised: T,
    /// Statistic that was compared with the thresholds: |ṽ|, or the t-test's T.
    pub statistic: T,
    /// The inner and the outer threshold of that (the outer is the number type's largest where there is
    /// none).
    pub thresholds: (T, T),
    /// Qᵥ / R when it was judged: the share of an error in this measurement that shows in its own
    /// residual.
    pub redundancy: T,
}

impl<T: Scalar> Decision<T> {
    /// Value of an array before the first update.
    pub const NONE: Self = Self {
        weight: T::ONE,
        reason: Reason::NoRedundancy,
        residual: T::ZERO,
        standardised: T::ZERO,
        statistic: T::ZERO,
        thresholds: (T::ZERO, T::ZERO),
        redundancy: T::ZERO,
    };

    /// Whether it had less than full weight.
    #[inline]
    pub fn was_treated(&self) -> bool {
        matches!(self.reason, Reason::DownWeighted | Reason::Rejected)
    }

    /// Whether it was judged and stands out: more than its inner threshold.
    #[inline(always)]
    pub(crate) fn is_suspect(&self) -> bool {
        self.reason == Reason::Agrees && self.statistic > self.thresholds.0
    }

    /// Leaves it this weight below one.
    #[inline(never)] // All at once and one by one: the code is there once.
    pub(crate) fn lose(&mut self, weight: T) {
        self.weight = weight;
        self.reason = if weight > T::ZERO { Reason::DownWeighted } else { Reason::Rejected };
    }

    /// Whether its residual can be compared with others, and it kept its full weight.
    #[inline(always)]
    pub(crate) fn counts(&self) -> bool {
        matches!(self.reason, Reason::Agrees | Reason::TooFew)
    }
}

impl<T: Scalar> Default for Decision<T> {
    fn default() -> Self {
        Self::NONE
    }
}

/// Summary of an epoch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Summary<T> {
    /// εᵀ Qε⁻¹ ε of all measurements before anything was weighted: as many as there are, on average.
    pub nis: T,
    /// σ̂0 as last estimated.
    pub scale: T,
    /// Number of down-weighted measurements.
    pub down_weighted: usize,
    /// Number of rejected measurements.
    pub rejected: usize,
    /// Number of passes through the epoch: 1 when no outlier was found.
    pub passes: usize,
    /// The statistic of the adaptive factor; 0 without one.
    pub discrepancy: T,
    /// a, the adaptive factor; 1 without one.
    pub adaptive_factor: T,
}
