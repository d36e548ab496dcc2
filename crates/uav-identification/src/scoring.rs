//! Fisher scoring: the Gauss-Newton method for innovations whose variance is estimated as well.

use nalgebra::{DMatrix, DVector};

use crate::Error;
use crate::likelihood::{Coordinate, Explained, Problem, Unknown};

const MOST_STEPS: usize = 60;
const MOST_TRIES: usize = 8;
/// Step of the finite differences, relative to the prior standard deviation.
const STEP: f64 = 1e-4;
/// Largest change of a noise logarithm in a step.
const LONGEST: f64 = 2.0;
/// Gain of log-likelihood below which the iteration ends.
const LEAST_GAIN: f64 = 0.02;

/// The maximum of the likelihood.
#[derive(Debug, Clone)]
pub(crate) struct Top {
    pub(crate) unknown: Unknown,
    pub(crate) coordinates: Vec<Coordinate>,
    pub(crate) explained: Explained,
    /// Derivatives of each innovation with respect to each coordinate.
    pub(crate) slopes: DMatrix<f64>,
    pub(crate) information: DMatrix<f64>,
}

/// The innovations' derivatives, the gradient of the cost, and the information matrix.
type Linear = (DMatrix<f64>, DVector<f64>, DMatrix<f64>);

fn linear(
    problem: &Problem,
    unknown: &Unknown,
    coordinates: &[Coordinate],
    at: &Explained,
) -> Result<Linear, Error> {
    let (rows, columns) = (at.off.len(), coordinates.len());
    let mut slopes = DMatrix::zeros(rows, columns);
    let mut widths = DMatrix::zeros(rows, columns);
    for (column, &coordinate) in coordinates.iter().enumerate() {
        let step = STEP * problem.expected(coordinate).1;
        let mut moved = *unknown;
        moved.add(coordinate, step);
        let there = problem.explain(&moved)?;
        for row in 0..rows {
            slopes[(row, column)] = (there.off[row] - at.off[row]) / step;
            widths[(row, column)] = (there.variance[row] - at.variance[row]) / step;
        }
    }
    let mut gradient = DVector::zeros(columns);
    let (mut weighted, mut spread) = (slopes.clone(), widths);
    for column in 0..columns {
        let mut sum = 0.0;
        let (mut slopes, mut widths) = (weighted.column_mut(column), spread.column_mut(column));
        let both = slopes.iter_mut().zip(widths.iter_mut());
        for (row, (slope, width)) in both.enumerate() {
            let (off, variance) = (at.off[row], at.variance[row]);
            sum += off * *slope / variance + 0.5 * (1.0 - off * off / variance) * *width / variance;
            *slope /= variance.sqrt();
            *width /= variance * std::f64::consts::SQRT_2;
        }
        gradient[column] = sum;
    }
    let information = weighted.tr_mul(&weighted) + spread.tr_mul(&spread);
    Ok((slopes, gradient, information))
}

/// Maximises the likelihood from a first guess.
pub(crate) fn climb(problem: &Problem, mut unknown: Unknown) -> Result<Top, Error> {
    let coordinates = problem.coordinates(&unknown);
    let mut explained = problem.explain(&unknown)?;
    let mut damping = 1e-3;
    for steps in 0.. {
        let (slopes, gradient, information) = linear(problem, &unknown, &coordinates, &explained)?;
        let mut better = None;
        for _ in 0..MOST_TRIES {
            let mut damped = information.clone();
            for place in 0..coordinates.len() {
                damped[(place, place)] *= 1.0 + damping;
            }
            let step = damped.cholesky().ok_or(Error::NotConverged)?.solve(&gradient);
            let mut moved = unknown;
            for (&coordinate, step) in coordinates.iter().zip(step.iter()) {
                let is_derivative = matches!(coordinate, Coordinate::Derivative(_));
                let longest = if is_derivative { f64::INFINITY } else { LONGEST };
                moved.add(coordinate, -step.clamp(-longest, longest));
            }
            let there = problem.explain(&moved).ok();
            if let Some(there) = there.filter(|there| there.cost < explained.cost) {
                damping = (damping / 10.0_f64).max(1e-9);
                better = Some((moved, there));
                break;
            }
            damping = (damping * 10.0).max(1e-4);
        }
        let gain = better.as_ref().map_or(0.0, |(_, there)| explained.cost - there.cost);
        if gain < LEAST_GAIN || steps >= MOST_STEPS {
            return Ok(Top { unknown, coordinates, explained, slopes, information });
        }
        if let Some((moved, there)) = better {
            (unknown, explained) = (moved, there);
        }
    }
    Err(Error::NotConverged)
}
