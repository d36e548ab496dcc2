//! Deviations over their sigmas, of which outliers count for a little: how large they are, and how alike the next is.

use crate::metrics::mean;

/// Means of deviations over their sigmas. Where these are right and the deviations independent, 1 and 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Clipped {
    /// Mean square.
    pub(crate) square: f64,
    /// Mean product of each with the next.
    pub(crate) product: f64,
}

impl Clipped {
    /// Of these; what is beyond `most` counts for as much.
    pub(crate) fn of(ratios: impl Iterator<Item = f64>, most: f64) -> Self {
        let clipped: Vec<f64> = ratios.map(|it| it.clamp(-most, most)).collect();
        let squares: Vec<f64> = clipped.iter().map(|it| it * it).collect();
        let products: Vec<f64> = clipped.windows(2).map(|pair| pair[0] * pair[1]).collect();
        Self { square: mean(&squares), product: mean(&products) }
    }
}
