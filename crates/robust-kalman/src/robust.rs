use crate::{
    Adaptive, AnyFactor, AnyScale, Block, Descent, Discrepancy, Igg3, NoFactor, Scale, TTest,
};
use crate::{UnitScale, Weight, WeightFunction};
use kestirim_scalar::Scalar;

/// How the robust weights are iterated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Reweighting {
    /// No reweighting: residuals are reported, weights stay 1.
    Never,
    /// All measurements at once, after the first pass.
    OneShot,
    /// The worst measurement alone, after which the others are judged anew, until none exceeds the inner threshold.
    /// Each measurement is treated once, at the cost of an update; the last judgement is on everything computed anew.
    WorstFirst {
        /// Largest number of measurements that are treated.
        #[cfg_attr(feature = "serde", serde(with = "limit"))]
        most: usize,
    },
}

/// Serialises a limit so that it means the same on targets whose `usize` has fewer bits: no limit stays no limit.
#[cfg(feature = "serde")]
mod limit {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[allow(clippy::trivially_copy_pass_by_ref)] // The signature that serde requires.
    pub(super) fn serialize<S: Serializer>(
        limit: &usize,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let limit = if *limit == usize::MAX { u64::MAX } else { *limit as u64 };
        limit.serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<usize, D::Error> {
        u64::deserialize(deserializer).map(|limit| usize::try_from(limit).unwrap_or(usize::MAX))
    }
}

/// A robust and optionally adaptive Kalman update for any measurements: how outliers are found and treated.
///
/// The five constructors are the five published filters. W is the weight function, S the scale and
/// A the adaptive factor; each is chosen at run time unless [`Robust::lean`] makes it a type.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Robust<T, W = Weight<T>, S = Scale<T>, A = Option<Adaptive<T>>> {
    /// Weight function.
    pub weight: W,
    /// Scale σ̂0 of the residuals.
    pub scale: S,
    /// How the weights are iterated.
    pub reweighting: Reweighting,
    /// Qᵥ/R up to which a measurement is not judged, because its residual shows next to nothing of an error.
    pub least_redundancy: T,
    /// Adaptive factor, if any.
    pub adaptive: A,
}

impl<T: Scalar> Robust<T> {
    /// GKF, the plain Kalman filter, which reports residuals all the same.
    pub fn plain() -> Self {
        Self { reweighting: Reweighting::Never, ..Self::igg3() }
    }

    /// RKF: IGG III weights on all measurements at once. A large outlier affects all residuals, so good
    /// measurements lose weight along with it.
    pub fn igg3() -> Self {
        Self {
            weight: Weight::Igg3(Igg3 {
                k0: T::from_f64(2.5),
                k1: T::from_f64(6.0),
                descent: Descent::Squared,
            }),
            scale: Scale::Unit,
            reweighting: Reweighting::OneShot,
            least_redundancy: T::from_f64(0.001),
            adaptive: None,
        }
    }

    /// SKF: classification by a t-test at 0.1 and 0.01.
    pub fn t_test() -> Self {
        let weight = Weight::TTest(TTest {
            alpha0: T::from_f64(0.1),
            alpha1: T::from_f64(0.01),
            descent: Descent::Published,
        });
        Self { weight, ..Self::igg3() }
    }

    /// IKF: IGG III on the worst measurement, repeated until none exceeds the inner threshold.
    pub fn iterative_igg3() -> Self {
        Self { reweighting: Reweighting::WorstFirst { most: usize::MAX }, ..Self::igg3() }
    }

    /// The published UKF (uyarlı, adaptive): IKF, then an adaptive factor on a block of the state.
    pub fn adaptive(block: Block) -> Self {
        Self { adaptive: Some(Adaptive::new(block)), ..Self::iterative_igg3() }
    }

    /// This filter with the published equations: σ̂0 of (17), the bracket of (15) and (21) without its
    /// square, the discrepancy of (22).
    #[must_use]
    pub fn published(self) -> Self {
        let descent = Descent::Published;
        let weight = match self.weight {
            Weight::Igg3(igg3) => Weight::Igg3(Igg3 { descent, ..igg3 }),
            Weight::TTest(test) => Weight::TTest(TTest { descent, ..test }),
            huber @ Weight::Huber(_) => huber,
        };
        let discrepancy = Discrepancy::Innovation;
        let adaptive = self.adaptive.map(|adaptive| Adaptive { discrepancy, descent, ..adaptive });
        Self { weight, scale: Scale::Epoch, adaptive, ..self }
    }
}

impl<T: Scalar, W, S, A> Robust<T, W, S, A> {
    /// The same filter with another weight function.
    #[must_use]
    pub fn with_weight<V: WeightFunction<T>>(self, weight: V) -> Robust<T, V, S, A> {
        let Self { scale, reweighting, least_redundancy, adaptive, .. } = self;
        Robust { weight, scale, reweighting, least_redundancy, adaptive }
    }

    /// The same filter with another weight function, σ̂0 = 1 and no adaptive factor, all of them as types, so that the
    /// code for the other choices takes no flash.
    #[must_use]
    pub fn lean<V: WeightFunction<T>>(self, weight: V) -> Robust<T, V, UnitScale, NoFactor> {
        let Self { reweighting, least_redundancy, .. } = self;
        let (scale, adaptive) = (UnitScale, NoFactor);
        Robust { weight, scale, reweighting, least_redundancy, adaptive }
    }
}

impl<T: Scalar, W: WeightFunction<T>, S: AnyScale<T>, A: AnyFactor<T>> Robust<T, W, S, A> {
    pub(crate) fn is_valid(&self) -> bool {
        self.weight.is_valid()
            && self.scale.choice().is_valid()
            && T::ZERO <= self.least_redundancy
            && self.least_redundancy < T::ONE
            && self.adaptive.choice().is_none_or(|adaptive| adaptive.is_valid())
    }
}
