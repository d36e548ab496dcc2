//! Size and correlation of normalised deviations, in which outliers count for little.

use crate::metrics::mean;

/// Means over normalised deviations (deviations over their sigmas). If the sigmas are right and the deviations
/// independent, they are 1 and 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Clipped {
    /// Mean square.
    pub(crate) square: f64,
    /// Mean product of successive deviations.
    pub(crate) product: f64,
}

impl Clipped {
    /// Computes the means; deviations are clipped to ±`most`.
    pub(crate) fn of(ratios: impl Iterator<Item = f64>, most: f64) -> Self {
        let clipped: Vec<f64> = ratios.map(|it| it.clamp(-most, most)).collect();
        let squares: Vec<f64> = clipped.iter().map(|it| it * it).collect();
        let products: Vec<f64> = clipped.windows(2).map(|pair| pair[0] * pair[1]).collect();
        Self { square: mean(&squares), product: mean(&products) }
    }
}
