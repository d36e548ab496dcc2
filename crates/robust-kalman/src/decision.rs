use kestirim_scalar::Scalar;

/// Reason for the weight that a measurement was given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Reason {
    /// The measurement agrees with the others and the prediction: full weight.
    Agrees,
    /// No other measurement checks it, as with the first phase of a satellite: full weight, not
    /// judged.
    NoRedundancy,
    /// There are fewer than the three measurements that a t-test needs: full weight, not judged.
    TooFew,
    /// The residual is between the two thresholds, or beyond Huber's: reduced weight.
    DownWeighted,
    /// The residual is beyond the outer threshold: no weight.
    Rejected,
}

/// Decision about one measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Decision<T> {
    /// γ in 0..=1, by which R was divided; 0 excludes the measurement.
    pub weight: T,
    /// Reason for the weight.
    pub reason: Reason,
    /// v = z − h(x⁺), the residual after the whole update, in the measurement's unit.
    pub residual: T,
    /// ṽ = v / (σ̂0 √Qᵥ) at the time of the judgement; 0 if not judged.
    pub standardised: T,
    /// Statistic that was compared with the thresholds: |ṽ|, or the t-test's T.
    pub statistic: T,
    /// Inner and outer threshold of the statistic (the outer one is the largest value of the number type if there is
    /// none).
    pub thresholds: (T, T),
    /// Qᵥ / R at the time of the judgement: the share of an error in this measurement that shows in its own
    /// residual.
    pub redundancy: T,
}

impl<T: Scalar> Decision<T> {
    /// Initial value of an array of decisions, before the first update.
    pub const NONE: Self = Self {
        weight: T::ONE,
        reason: Reason::NoRedundancy,
        residual: T::ZERO,
        standardised: T::ZERO,
        statistic: T::ZERO,
        thresholds: (T::ZERO, T::ZERO),
        redundancy: T::ZERO,
    };

    /// Whether the measurement was down-weighted or rejected.
    #[inline]
    pub fn was_treated(&self) -> bool {
        matches!(self.reason, Reason::DownWeighted | Reason::Rejected)
    }

    /// Whether the measurement was judged and its statistic exceeds the inner threshold.
    #[inline(always)]
    pub(crate) fn is_suspect(&self) -> bool {
        self.reason == Reason::Agrees && self.statistic > self.thresholds.0
    }

    /// Reduces the weight to `weight`, which is below one, and sets the reason accordingly.
    #[inline(never)] // Called by one-shot and worst-first treatment: one copy of the code.
    pub(crate) fn lose(&mut self, weight: T) {
        self.weight = weight;
        self.reason = if weight > T::ZERO { Reason::DownWeighted } else { Reason::Rejected };
    }

    /// Whether the residual can be compared with others and the measurement kept its full weight.
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

/// Summary of the update by one epoch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Summary<T> {
    /// εᵀ Qε⁻¹ ε of all measurements before any was weighted: equal to their number, on average.
    pub nis: T,
    /// σ̂0 as estimated last.
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
