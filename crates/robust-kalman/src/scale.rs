use crate::Decision;
use crate::student::whole;
use kestirim_scalar::Scalar;

/// σ̂0, how much larger errors are than their variances say; residuals are judged in units of it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Scale<T> {
    /// 1: the variances are believed.
    Unit,
    /// √(εᵀ Qε⁻¹ ε / n) (17). Outliers inflate it and so hide behind it: among n measurements a single
    /// one of any size has |ṽ| ≤ √n or so.
    Epoch,
    /// 1.4826 · median |v/√Qᵥ|, but no less than the floor: half of the measurements may be wild.
    Median {
        /// The smallest σ̂0, usually 1: few residuals that happen to be small do not make the others
        /// outliers.
        floor: T,
    },
}

impl<T: Scalar> Scale<T> {
    /// σ̂0 from the NIS of `used` measurements, or from decisions that hold v/√Qᵥ.
    pub(crate) fn estimate(&self, nis: T, used: usize, decisions: &[Decision<T>]) -> T {
        let estimate = match *self {
            Self::Epoch if used > 0 => (nis / whole(used)).sqrt(),
            Self::Unit | Self::Epoch => T::ONE,
            Self::Median { floor } => match median(decisions) {
                Some(median) => (T::from_f64(1.4826) * median).max(floor),
                None => floor,
            },
        };
        // Nothing is a multiple of zero.
        if estimate > T::ZERO { estimate } else { T::ONE }
    }

    pub(crate) fn is_valid(&self) -> bool {
        !matches!(self, Self::Median { floor } if !(*floor > T::ZERO && floor.is_finite()))
    }
}

/// Of |v/√Qᵥ| of the measurements that count. By counting, so that nothing needs to be stored.
fn median<T: Scalar>(decisions: &[Decision<T>]) -> Option<T> {
    let count = decisions.iter().filter(|decision| decision.counts()).count();
    let upper = ranked(decisions, count / 2)?;
    let lower = if count % 2 == 0 { ranked(decisions, count / 2 - 1)? } else { upper };
    Some(lower + (upper - lower) * T::HALF)
}

/// The value that `rank` others are below of, or as large as.
fn ranked<T: Scalar>(decisions: &[Decision<T>], rank: usize) -> Option<T> {
    let values = || decisions.iter().filter(|d| d.counts()).map(|d| d.standardised.abs());
    values().find(|&value| {
        let below = values().filter(|&other| other < value).count();
        below <= rank && rank < below + values().filter(|&other| other == value).count()
    })
}
