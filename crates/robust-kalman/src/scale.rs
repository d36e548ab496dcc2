use crate::judge::Epoch;
use crate::pass::Passed;
use crate::student::whole;
use crate::{Decision, Reason};
use kestirim_scalar::Scalar;

/// σ̂0, how much larger errors are than their variances say; residuals are judged in units of it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Scale<T> {
    /// 1: the variances are trusted. Where they are right, this finds most outliers.
    Unit,
    /// √(εᵀ Qε⁻¹ ε / n) (17). Outliers inflate it and so mask themselves: among n measurements no |ṽ|
    /// is larger than √n, whatever the error. With k1 = 6 nothing is rejected among fewer than 37.
    Epoch,
    /// 1.4826 · median |ε/√(h P⁻ hᵀ + R)|, but no less than the floor: half of the measurements may be
    /// wild. Where all are off at once it grows, and nothing is rejected; of a state that is hardly
    /// predicted, such as a receiver's clock, it hardly exceeds the floor.
    Innovations {
        /// The smallest σ̂0, usually 1: few innovations that happen to be small do not make the others
        /// outliers.
        floor: T,
    },
    /// The same of the residuals, |v/√Qᵥ|, after every pass: it sees noise that is larger than it should
    /// be whatever the prediction. But with few measurements to a state, one outlier spreads over the
    /// residuals of all.
    Residuals {
        /// The smallest σ̂0, usually 1.
        floor: T,
    },
}

impl<T: Scalar> Scale<T> {
    /// Scale from the innovations, before anything is judged: σ̂0 for the whole epoch, if it comes from them.
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
        // Nothing is a multiple of zero.
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

/// A choice of σ̂0: at run time, or a type.
pub trait AnyScale<T> {
    /// Which it is.
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

/// Median of |ṽ| of the measurements that count; of an even number the lower one of the two in the middle, so that
/// of four measurements two may be wild. By counting, so that nothing needs to be stored.
fn median<T: Scalar>(decisions: &[Decision<T>]) -> Option<T> {
    let count = decisions.iter().filter(|decision| decision.counts()).count();
    ranked(decisions, count.checked_sub(1)? / 2)
}

/// The value that `rank` others are below of, or as large as.
fn ranked<T: Scalar>(decisions: &[Decision<T>], rank: usize) -> Option<T> {
    let values = || decisions.iter().filter(|d| d.counts()).map(|d| d.standardised.abs());
    values().find(|&value| {
        let below = values().filter(|&other| other < value).count();
        below <= rank && rank < below + values().filter(|&other| other == value).count()
    })
}
