//! Uncertainty of the parameters when residuals are coloured.

use nalgebra::{DMatrix, DVector};

use crate::flight::OUTPUTS;
use crate::likelihood::Problem;
use crate::scoring::Top;

/// Longest time over which residuals are taken to be correlated, s.
const LONGEST_S: f64 = 3.0;

/// The normalised residuals of an output in a stretch, and their rows among all innovations.
struct Channel {
    residuals: Vec<f64>,
    rows: Vec<usize>,
}

/// The residuals by stretch and output.
fn channels(problem: &Problem, top: &Top) -> Vec<(usize, Channel)> {
    let mut channels = Vec::new();
    let mut row = 0;
    for segment in &problem.segments {
        let mut of: [Channel; OUTPUTS] =
            std::array::from_fn(|_| Channel { residuals: Vec::new(), rows: Vec::new() });
        for measured in &segment.measured {
            for (output, _) in measured.iter().enumerate().filter(|(_, it)| it.is_some()) {
                let off = top.explained.off[row] / top.explained.variance[row].sqrt();
                of[output].residuals.push(off);
                of[output].rows.push(row);
                row += 1;
            }
        }
        channels.extend(of.into_iter().enumerate());
    }
    channels
}

/// Autocovariance of the values at lags of 0, 1, … samples (the biased estimate).
pub(crate) fn autocorrelation(values: &[f64], lags: usize) -> Vec<f64> {
    let count = values.len().max(1) as f64;
    (0..lags.min(values.len()))
        .map(|lag| values.iter().zip(&values[lag..]).map(|(a, b)| a * b).sum::<f64>() / count)
        .collect()
}

/// The covariance of the coordinates, F⁻¹ (Σ sᵢ ρ(i − j) sⱼᵀ) F⁻¹, with the autocorrelation ρ of each output's
/// residuals (Maine & Iliff, NASA RP-1077, 1981; Morelli & Klein, J. Aircraft 34(2), 1997).
pub(crate) fn covariance(
    problem: &Problem,
    top: &Top,
    // The inverse information F⁻¹.
    inverse: &DMatrix<f64>,
) -> DMatrix<f64> {
    let lags = (LONGEST_S / problem.reference.interval).ceil() as usize;
    let columns = top.coordinates.len();
    let mut middle = DMatrix::<f64>::zeros(columns, columns);
    let mut white = DMatrix::<f64>::zeros(columns, columns);
    for (_, Channel { residuals, rows }) in channels(problem, top) {
        if rows.is_empty() {
            continue;
        }
        let lags = lags.min(rows.len() / 4).max(1);
        let correlation = autocorrelation(&residuals, lags);
        let slopes = DMatrix::from_fn(rows.len(), columns, |line, column| {
            top.slopes[(rows[line], column)] / top.explained.variance[rows[line]].sqrt()
        });
        let mut coloured = &slopes * correlation[0];
        for (lag, rho) in correlation.iter().enumerate().skip(1) {
            // Bartlett's taper keeps the sum positive.
            let rho = rho * (1.0 - lag as f64 / lags as f64);
            let left = rows.len() - lag;
            let ahead = slopes.rows(lag, left) * rho;
            let behind = slopes.rows(0, left) * rho;
            let mut upper = coloured.rows_mut(0, left);
            upper += ahead;
            let mut lower = coloured.rows_mut(lag, left);
            lower += behind;
        }
        middle += slopes.tr_mul(&coloured);
        white += slopes.tr_mul(&slopes);
    }
    // The contributions of the priors and of the noise parameters are unchanged.
    let rest = &top.information - white;
    let coloured = inverse * (middle + rest) * inverse;
    // Coloured residuals can only increase the uncertainty.
    let least = DVector::from_fn(columns, |place, _| {
        (inverse[(place, place)] / coloured[(place, place)].max(f64::MIN_POSITIVE)).max(1.0).sqrt()
    });
    DMatrix::from_fn(columns, columns, |row, column| {
        coloured[(row, column)] * least[row] * least[column]
    })
}

/// Whiteness of the residuals of an output.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Whiteness {
    /// Correlation of successive residuals; 0 if they are white.
    pub next: f64,
    /// Share of the correlations at lags up to one second that are within the 95 % bound of white noise.
    pub within: f64,
    /// Root mean square of the residuals over the filter's standard deviation; 1 if the filter is consistent.
    pub ratio: f64,
}

/// The whiteness of each available output, over all stretches together.
pub(crate) fn whiteness(problem: &Problem, top: &Top) -> [Option<Whiteness>; OUTPUTS] {
    let lags = ((1.0 / problem.reference.interval).ceil() as usize).max(2);
    let channels = channels(problem, top);
    std::array::from_fn(|output| {
        let mut sums = vec![0.0; lags];
        let mut count = 0;
        for (of, channel) in &channels {
            if *of != output || channel.residuals.len() <= lags {
                continue;
            }
            let length = channel.residuals.len();
            for (sum, rho) in sums.iter_mut().zip(autocorrelation(&channel.residuals, lags)) {
                *sum += rho * length as f64;
            }
            count += length;
        }
        if count == 0 || sums[0] <= 0.0 {
            return None;
        }
        let bound = 1.96 / (count as f64).sqrt();
        let within = sums[1..].iter().filter(|sum| (**sum / sums[0]).abs() <= bound).count();
        Some(Whiteness {
            next: sums[1] / sums[0],
            within: within as f64 / (lags - 1) as f64,
            ratio: (sums[0] / count as f64).sqrt(),
        })
    })
}
