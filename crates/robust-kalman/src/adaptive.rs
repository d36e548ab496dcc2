use crate::{Descent, Error, MOST_STATES};
use kestirim_scalar::Scalar;

/// A block of neighbouring states on which an adaptive factor acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Block {
    /// Index of the first state.
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
    /// √(εᵀε / tr Qε) (22, whose root is published around the trace alone). Dominated by the state with
    /// the largest prior variance, such as a receiver's clock.
    Innovation,
    /// √(dᵀ C⁻¹ d / count), where d is the distance of the block from its prediction according to the epoch alone,
    /// given all that is known of the *other* states, and C the covariance of that distance. 1 on average.
    Block,
    /// ‖d‖ / √tr P⁻ of the block (Yang, He and Xu 2001): the distance d of [`Discrepancy::Block`] in units of the
    /// prediction alone. Where the epoch is less precise than the prediction, it responds to noise.
    Prediction,
}

/// Order in which the adaptive factor and the weights are determined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Order {
    /// The factor after the weights, as published: no outlier is mistaken for motion, but
    /// a motion that all measurements show may be mistaken for outliers.
    AfterWeights,
    /// The factor before the weights: no motion is mistaken for outliers, but an outlier may be mistaken for motion.
    BeforeWeights,
    /// The factor after the weights, unless more than a third of the measurements would lose weight: that is taken for
    /// motion, and they are judged anew once the block has been inflated.
    ByMajority,
}

/// An adaptive factor a ≤ 1, by which a block of P⁻ is divided.
///
/// The rest of P⁻ is kept, including the covariances with the block: applied to all of P⁻, a would discard what is not
/// in doubt, and a deviation of the block would be attributed to states that correlate with it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Adaptive<T> {
    /// The states in doubt.
    pub block: Block,
    /// Statistic by which the prediction of these states is judged.
    pub discrepancy: Discrepancy,
    /// c0, the discrepancy up to which the prediction has full weight, a = 1; usually 1.5 to 3.
    pub c0: T,
    /// c1, the discrepancy beyond which a is at its floor; usually 3 to 8.
    pub c1: T,
    /// Course of a between c0 and c1.
    pub descent: Descent,
    /// The smallest a (0 as published, by which (13) cannot divide).
    pub floor: T,
    /// Order in which the factor and the weights are determined.
    pub order: Order,
}

/// A choice of the adaptive factor, at run time or by a type.
pub trait AnyFactor<T> {
    /// Whether there can be a factor; if not, [`AnyFactor::choice`] is not called.
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

/// The absence of an adaptive factor, as a type.
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
    /// Default settings: the block's own discrepancy, which is sharper than the published one, between 3 and 8; no
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

    /// a, in `floor..=1`, for a discrepancy ≥ 0.
    #[inline]
    pub fn factor(&self, discrepancy: T) -> T {
        self.descent.factor(discrepancy, self.c0, self.c1).max(self.floor)
    }

    pub(crate) fn is_valid(&self) -> bool {
        let ordered = T::ZERO < self.c0 && self.c0 <= self.c1 && self.c1.is_finite();
        ordered && T::ZERO < self.floor && self.floor <= T::ONE
    }
}
