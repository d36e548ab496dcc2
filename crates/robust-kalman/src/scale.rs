use crate::judge::Epoch;
use crate::pass::Passed;
use crate::student::whole;
use crate::{Decision, Reason};
use kestirim_scalar::Scalar;

/// σ̂0, the ratio of the actual errors to the standard deviations assumed; residuals are judged in units of it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Scale<T> {
    /// 1: the variances are trusted. Where they are right, this choice finds the most outliers.
    Unit,
    /// √(εᵀ Qε⁻¹ ε / n) (17). Outliers inflate it and so mask themselves: among n measurements no |ṽ|
    /// exceeds √n, whatever the error. With k1 = 6 nothing is rejected among fewer than 37.
    Epoch,
    /// 1.4826 · median |ε/√(h P⁻ hᵀ + R)|, but at least the floor: half of the measurements may be
    /// outliers. Where all are off at once it grows, and nothing is rejected; where a state is hardly
    /// predicted, such as a receiver's clock, it hardly exceeds the floor.
    Innovations {
        /// The smallest σ̂0, usually 1, so that a few innovations that happen to be small do not make the others
        /// outliers.
        floor: T,
    },
    /// 1.4826 · median |v/√Qᵥ| of the residuals after every pass, but at least the floor: it reveals noise that is
    /// larger than assumed, whatever the prediction. But with few measurements per state, one outlier spreads over the
    /// residuals of all.
    Residuals {
        /// The smallest σ̂0, usually 1.
        floor: T,
    },
}

impl<T: Scalar> Scale<T> {
    /// σ̂0 of the whole epoch from the innovations, before anything is judged; `None` unless this scale uses them.
    #[inline(always)]
    pub(crate) fn of_innovations<const N: usize>(
        &self,
        epoch: &Epoch<'_, '_, T, N>,
        decisions: &mut [Decision<T>],
    ) -> Option<T> {
        let Self::Innovations { floor } = *self else { return None };
        for (measurement, decision) in epoch.measurements.iter().zip(&mut *decisions) {
            let variance = measurement.spread(epoch.prior) + measurement.variance;
            decision.standardised = measurement.innovation / variance.sqrt();
            decision.reason = Reason::Agrees;
        }
        Some(from_median(decisions, floor))
    }

    /// σ̂0 after a pass, from decisions that hold v/√Qᵥ.
    #[inline(always)]
    pub(crate) fn of_residuals(&self, passed: &Passed<T>, decisions: &[Decision<T>]) -> T {
        let estimate = match *self {
            Self::Epoch if passed.used > 0 => (passed.nis / whole(passed.used)).sqrt(),
            Self::Residuals { floor } => from_median(decisions, floor),
            _ => T::ONE,
        };
        // A scale of zero cannot divide residuals.
        if estimate > T::ZERO { estimate } else { T::ONE }
    }

    pub(crate) fn is_valid(&self) -> bool {
        match *self {
            Self::Innovations { floor } | Self::Residuals { floor } => {
                floor > T::ZERO && floor.is_finite()
            }
            Self::Unit | Self::Epoch => true,
        }
    }
}

/// A choice of σ̂0, at run time or by a type.
pub trait AnyScale<T> {
    /// The scale chosen.
    fn choice(&self) -> Scale<T>;
}

impl<T: Scalar> AnyScale<T> for Scale<T> {
    #[inline(always)]
    fn choice(&self) -> Scale<T> {
        *self
    }
}

/// [`Scale::Unit`] as a type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct UnitScale;

impl<T> AnyScale<T> for UnitScale {
    #[inline(always)]
    fn choice(&self) -> Scale<T> {
        Scale::Unit
    }
}

fn from_median<T: Scalar>(decisions: &[Decision<T>], floor: T) -> T {
    median(decisions).map_or(floor, |median| (T::from_f64(1.4826) * median).max(floor))
}

/// Median of |ṽ| of the measurements that count; of an even number the lower of the middle two, so that
/// two of four measurements may be outliers. Found by counting, so that nothing needs to be stored.
fn median<T: Scalar>(decisions: &[Decision<T>]) -> Option<T> {
    let count = decisions.iter().filter(|decision| decision.counts()).count();
    ranked(decisions, count.checked_sub(1)? / 2)
}

/// The value of this rank, counted from 0, in ascending order of |ṽ|.
fn ranked<T: Scalar>(decisions: &[Decision<T>], rank: usize) -> Option<T> {
    let values = || decisions.iter().filter(|d| d.counts()).map(|d| d.standardised.abs());
    values().find(|&value| {
        let below = values().filter(|&other| other < value).count();
        below <= rank && rank < below + values().filter(|&other| other == value).count()
    })
}
