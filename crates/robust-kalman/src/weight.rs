use crate::student_quantile;
use kestirim_scalar::Scalar;

/// Course of a weight between two thresholds.
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
    /// The weight for a statistic `s` ≥ 0: 1 up to `inner`, 0 beyond `outer`.
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
        // NaN ends up here, too, and gets no weight.
        T::ZERO
    }
}

/// A weight function: the weight of a measurement as a function of its standardised residual.
///
/// [`Weight`] chooses among the three of this crate at run time. Each of them is also a type of its own, and any other
/// can be passed to [`Robust::with_weight`](crate::Robust::with_weight).
pub trait WeightFunction<T> {
    /// Inner and outer threshold for `count` measurements that can be judged; `None` if that is too few
    /// to judge any. They are reported, and passed to [`WeightFunction::factor`].
    fn thresholds(&self, count: usize) -> Option<(T, T)>;

    /// γ in 0..=1 for a statistic ≥ 0, given these thresholds. It must never increase with the statistic.
    fn factor(&self, statistic: T, thresholds: (T, T)) -> T;

    /// Whether the parameters are valid; if not, an update is refused.
    fn is_valid(&self) -> bool;

    /// Whether the statistic is T (20), the distance of ṽ from the mean of the others in units of their standard
    /// deviation, instead of |ṽ|.
    fn is_t_test(&self) -> bool {
        false
    }
}

/// Huber's weight: γ = k/|ṽ| beyond k, so that nothing is ever rejected (Huber 1964).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Huber<T> {
    /// k, the threshold of |ṽ|; usually 1.345 to 3.
    pub k: T,
}

/// IGG III weights in three parts: full up to k0, reduced up to k1, zero beyond (Yang, Song and Xu 2002).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Igg3<T> {
    /// k0, the |ṽ| up to which the weight is full; usually 1 to 3.
    pub k0: T,
    /// k1, the |ṽ| beyond which the weight is zero; usually 3 to 8.
    pub k1: T,
    /// Course of the weight between k0 and k1.
    pub descent: Descent,
}

/// IGG III weights with two-sided thresholds from Student's t of n − 2 degrees of freedom. The statistic T is the
/// distance of ṽ from the mean of the others in units of their standard deviation (20; Zhang et al. 2018).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TTest<T> {
    /// α0, the share of good measurements that may be down-weighted: 0.1.
    pub alpha0: T,
    /// α1, the share of good measurements that may be rejected: 0.01.
    pub alpha1: T,
    /// Course of the weight between the two thresholds.
    pub descent: Descent,
}

/// A choice among the weight functions of this crate at run time.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Weight<T> {
    /// Huber's weight: see [`struct@Huber`].
    Huber(Huber<T>),
    /// IGG III: see [`struct@Igg3`].
    Igg3(Igg3<T>),
    /// The t-test: see [`struct@TTest`].
    TTest(TTest<T>),
}

impl<T: Scalar> WeightFunction<T> for Huber<T> {
    /// k, and the largest value of the number type.
    #[inline]
    fn thresholds(&self, _: usize) -> Option<(T, T)> {
        Some((self.k, T::MAX))
    }

    #[inline]
    fn factor(&self, statistic: T, (inner, outer): (T, T)) -> T {
        if statistic > inner {
            return inner / statistic;
        }
        Descent::Published.factor(statistic, inner, outer)
    }

    #[inline]
    fn is_valid(&self) -> bool {
        T::ZERO < self.k && self.k.is_finite()
    }
}

impl<T: Scalar> WeightFunction<T> for Igg3<T> {
    #[inline]
    fn thresholds(&self, _: usize) -> Option<(T, T)> {
        Some((self.k0, self.k1))
    }

    #[inline]
    fn factor(&self, statistic: T, (inner, outer): (T, T)) -> T {
        self.descent.factor(statistic, inner, outer)
    }

    #[inline]
    fn is_valid(&self) -> bool {
        T::ZERO < self.k0 && self.k0 <= self.k1 && self.k1.is_finite()
    }
}

impl<T: Scalar> WeightFunction<T> for TTest<T> {
    /// The quantiles of `count` − 2 degrees of freedom; `None` for fewer than three measurements.
    #[inline]
    fn thresholds(&self, count: usize) -> Option<(T, T)> {
        let freedom = count.checked_sub(2).filter(|&freedom| freedom > 0)?;
        Some((student_quantile(self.alpha0, freedom), student_quantile(self.alpha1, freedom)))
    }

    #[inline]
    fn factor(&self, statistic: T, (inner, outer): (T, T)) -> T {
        self.descent.factor(statistic, inner, outer)
    }

    #[inline]
    fn is_valid(&self) -> bool {
        T::ZERO < self.alpha1 && self.alpha1 <= self.alpha0 && self.alpha0 < T::ONE
    }

    #[inline]
    fn is_t_test(&self) -> bool {
        true
    }
}

impl<T: Scalar> WeightFunction<T> for Weight<T> {
    #[inline]
    fn thresholds(&self, count: usize) -> Option<(T, T)> {
        match self {
            Self::Huber(huber) => huber.thresholds(count),
            Self::Igg3(igg3) => igg3.thresholds(count),
            Self::TTest(test) => test.thresholds(count),
        }
    }

    #[inline]
    fn factor(&self, statistic: T, thresholds: (T, T)) -> T {
        match self {
            Self::Huber(huber) => huber.factor(statistic, thresholds),
            // The same as both types do themselves; a single arm has the code once.
            Self::Igg3(Igg3 { descent, .. }) | Self::TTest(TTest { descent, .. }) => {
                let (inner, outer) = thresholds;
                descent.factor(statistic, inner, outer)
            }
        }
    }

    #[inline]
    fn is_valid(&self) -> bool {
        match self {
            Self::Huber(huber) => huber.is_valid(),
            Self::Igg3(igg3) => igg3.is_valid(),
            Self::TTest(test) => test.is_valid(),
        }
    }

    #[inline]
    fn is_t_test(&self) -> bool {
        matches!(self, Self::TTest(_))
    }
}
