use crate::{Descent, Error, MOST_STATES};
use kestirim_scalar::Scalar;

/// Neighbouring states that an adaptive factor acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Block {
    /// The index of the first.
    pub first: usize,
    /// Number of states, up to [`MOST_STATES`].
    pub count: usize,
}

impl Block {
    /// `count` states from index `first` on.
    pub const fn new(first: usize, count: usize) -> Self {
        Self { first, count }
    }

    pub(crate) fn check<const N: usize>(self) -> Result<(), Error> {
        let end = self.first.checked_add(self.count);
        let within = end.is_some_and(|end| end <= N) && (1..=MOST_STATES).contains(&self.count);
        if within { Ok(()) } else { Err(Error::InvalidBlock) }
    }
}

/// Statistic by which the prediction is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Discrepancy {
    /// √(εᵀε / tr Qε) (22, whose root is published around the trace alone). It is dominated by the state of
    /// the largest prior variance, such as a receiver's clock.
    Innovation,
    /// √(dᵀ C⁻¹ d / count): d is how far the epoch alone, with all that is known of the *other* states,
    /// puts the block from its prediction, C the covariance of that distance. 1 on average.
    Block,
    /// ‖d‖ / √tr P⁻ of the block (Yang, He and Xu 2001): the same distance in units of the prediction
    /// alone. Where the epoch is less precise than the prediction it fires at noise.
    Prediction,
}

/// Order of adaptive factor and weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Order {
    /// After the measurements have their weights, as published: no outlier is taken for motion, but
    /// a motion that all measurements show may be taken for outliers.
    AfterWeights,
    /// Before: no motion is taken for outliers, but an outlier may be taken for motion.
    BeforeWeights,
    /// After, unless more than a third of the measurements would lose weight: then it was motion, and
    /// they are judged anew when the block has been put in doubt.
    ByMajority,
}

/// An adaptive factor a ≤ 1 on a block of P⁻: the block over a. The rest of P⁻ is kept, with what ties it
/// to the block: on all of it, a would discard what is not in doubt, and a deviation of the block would be
/// taken for one of the states that correlate with it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Adaptive<T> {
    /// The states in doubt.
    pub block: Block,
    /// Statistic by which they are judged.
    pub discrepancy: Discrepancy,
    /// Up to c0 the prediction has full weight, a = 1; usually 1.5 to 3.
    pub c0: T,
    /// Beyond c1 the factor a is at its floor; usually 3 to 8.
    pub c1: T,
    /// Course of a between them.
    pub descent: Descent,
    /// The smallest a (published as 0, by which (13) cannot divide).
    pub floor: T,
    /// Order of factor and weights.
    pub order: Order,
}

/// A choice of the adaptive factor: at run time, or a type.
pub trait AnyFactor<T> {
    /// Whether there may be one; where not, it is not asked for.
    const POSSIBLE: bool;

    /// The factor, if there is one.
    fn choice(&self) -> Option<Adaptive<T>>;
}

impl<T: Scalar> AnyFactor<T> for Option<Adaptive<T>> {
    const POSSIBLE: bool = true;

    #[inline(always)]
    fn choice(&self) -> Option<Adaptive<T>> {
        *self
    }
}

/// No adaptive factor, as a type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NoFactor;

impl<T> AnyFactor<T> for NoFactor {
    const POSSIBLE: bool = false;

    #[inline(always)]
    fn choice(&self) -> Option<Adaptive<T>> {
        None
    }
}

impl<T: Scalar> Adaptive<T> {
    /// Defaults: the block's own discrepancy between 3 and 8, as it is sharper than the published one; no
    /// factor below 0.05.
    pub fn new(block: Block) -> Self {
        Self {
            block,
            discrepancy: Discrepancy::Block,
            c0: T::from_f64(3.0),
            c1: T::from_f64(8.0),
            descent: Descent::Squared,
            floor: T::from_f64(0.05),
            order: Order::AfterWeights,
        }
    }

    /// a in floor..=1 of a discrepancy ≥ 0.
    #[inline]
    pub fn factor(&self, discrepancy: T) -> T {
        self.descent.factor(discrepancy, self.c0, self.c1).max(self.floor)
    }

    pub(crate) fn is_valid(&self) -> bool {
        let ordered = T::ZERO < self.c0 && self.c0 <= self.c1 && self.c1.is_finite();
        ordered && T::ZERO < self.floor && self.floor <= T::ONE
    }
}
