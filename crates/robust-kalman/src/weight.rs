use crate::student_quantile;
use kestirim_scalar::Scalar;

/// How a weight falls between two thresholds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Descent {
    /// k0/s · (k1 − s)/(k1 − k0), as published (15, 19, 21).
    Published,
    /// k0/s · ((k1 − s)/(k1 − k0))², the original (Yang, Song and Xu 2002), without a kink at k1.
    Squared,
}

impl Descent {
    /// The factor of statistic `s` ≥ 0: 1 up to `inner`, 0 beyond `outer`.
    #[inline]
    pub fn factor<T: Scalar>(self, s: T, inner: T, outer: T) -> T {
        if s <= inner {
            return T::ONE;
        }
        if s < outer {
            let rest = (outer - s) / (outer - inner);
            let rest = if self == Self::Squared { rest * rest } else { rest };
            return (inner / s * rest).clamp(T::ZERO, T::ONE);
        }
        // NaN too has no say.
        T::ZERO
    }
}

/// How much a measurement is believed, by how far it stands out.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Weight<T> {
    /// γ = k/|ṽ| beyond k: nothing is ever rejected (Huber 1964).
    Huber {
        /// k, usually 1.345 to 3.
        k: T,
    },
    /// Three parts: full weight up to k0, less up to k1, none beyond (Yang, Song and Xu 2002).
    Igg3 {
        /// k0, usually 1 to 3.
        k0: T,
        /// k1, usually 3 to 8.
        k1: T,
        /// How it falls between them.
        descent: Descent,
    },
    /// The same with thresholds from Student's t of n − 2 degrees of freedom, both sides: T is the
    /// distance of ṽ from the mean of the others in their standard deviations (20; Zhang et al. 2018).
    TTest {
        /// α0, the share of good measurements that are to be down-weighted: 0.1.
        alpha0: T,
        /// α1, the share of those that are to be rejected: 0.01.
        alpha1: T,
        /// How it falls between them.
        descent: Descent,
    },
}

impl<T: Scalar> Weight<T> {
    /// The inner and the outer threshold among `count` measurements that can be judged. Huber's outer
    /// one is the largest number; a t-test has none (`None`) for fewer than three.
    pub fn thresholds(&self, count: usize) -> Option<(T, T)> {
        match *self {
            Self::Huber { k } => Some((k, T::MAX)),
            Self::Igg3 { k0, k1, .. } => Some((k0, k1)),
            Self::TTest { alpha0, alpha1, .. } => {
                let freedom = count.checked_sub(2).filter(|&freedom| freedom > 0)?;
                Some((student_quantile(alpha0, freedom), student_quantile(alpha1, freedom)))
            }
        }
    }

    /// γ in 0..=1 of a statistic ≥ 0 between such thresholds. It never rises with the statistic.
    #[inline]
    pub fn factor(&self, statistic: T, (inner, outer): (T, T)) -> T {
        match *self {
            Self::Huber { .. } if statistic > inner => inner / statistic,
            Self::Huber { .. } => Descent::Published.factor(statistic, inner, outer),
            Self::Igg3 { descent, .. } | Self::TTest { descent, .. } => {
                descent.factor(statistic, inner, outer)
            }
        }
    }

    /// Whether the thresholds can be used.
    pub(crate) fn is_valid(&self) -> bool {
        match *self {
            Self::Huber { k } => T::ZERO < k && k.is_finite(),
            Self::Igg3 { k0, k1, .. } => T::ZERO < k0 && k0 <= k1 && k1.is_finite(),
            Self::TTest { alpha0, alpha1, .. } => {
                T::ZERO < alpha1 && alpha1 <= alpha0 && alpha0 < T::ONE
            }
        }
    }
}
