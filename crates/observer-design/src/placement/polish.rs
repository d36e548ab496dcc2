//! Search for the best neighbour of a rounded gain.
//!
//! Poles that lie close together depend on the last bit of every gain. There are at least as many gains as poles, so
//! among the doubles around the exact gain some place the poles far better than the nearest doubles do.

use super::problem::{Checked, Problem};
use crate::eigenvalues::eigenvector;
use crate::extended::Extended;
use crate::number::{Times, complex, extend, extend_complex, round_complex};
use crate::sequence::Sequence;
use nalgebra::{Complex, SMatrix, SVector};

/// Relative error below which poles are not improved further.
const GOOD_ENOUGH: f64 = 4.0 * f64::EPSILON;
/// Number of random neighbours that are tried, and their largest distance in units in the last place.
const NEIGHBOURS: u32 = 400;
const REACH: f64 = 6.0;
/// Limit on the rounds over all gains, in each of which every gain is improved by itself.
const ROUNDS: u32 = 6;

/// Motion of each pole, relative to its magnitude, when a gain moves by one unit in its last place.
type Slopes<const N: usize, const P: usize> = SMatrix<SVector<Complex<f64>, N>, N, P>;

/// A gain next to the checked one that places the poles better according to first derivatives; `None` if
/// nothing can be improved, or if poles coincide and have no derivative.
pub(super) fn polish<const N: usize, const P: usize>(
    problem: &Problem<N, P>,
    checked: &Checked<N, P>,
) -> Option<SMatrix<f64, N, P>> {
    if checked.error <= GOOD_ENOUGH {
        return None;
    }
    let slopes = slopes(problem, checked)?;
    let start = SVector::<Complex<f64>, N>::from_fn(|pole, _| {
        checked.offsets[pole] / problem.reference(problem.poles[pole])
    });
    let mut random = Sequence::new(0);
    let mut best = (worst(&start), SMatrix::<f64, N, P>::zeros());
    for neighbour in 0..NEIGHBOURS {
        let reach = if neighbour == 0 { 0.0 } else { REACH };
        let mut steps = SMatrix::<f64, N, P>::from_fn(|_, _| libm::round(reach * random.next()));
        let mut offsets = start;
        for (slope, &step) in slopes.iter().zip(steps.iter()) {
            offsets += slope.map(|slope| slope * step);
        }
        improve(&slopes, &mut offsets, &mut steps);
        if worst(&offsets) < best.0 {
            best = (worst(&offsets), steps);
        }
    }
    let moved = checked.gain.zip_map(&best.1, |gain, steps| gain + steps * last_place(gain));
    (moved != checked.gain).then_some(moved)
}

/// Moves one gain after the other by whole units in the last place, to the smallest sum of squared offsets.
fn improve<const N: usize, const P: usize>(
    slopes: &Slopes<N, P>,
    offsets: &mut SVector<Complex<f64>, N>,
    steps: &mut SMatrix<f64, N, P>,
) {
    for _ in 0..ROUNDS {
        let mut moved = false;
        for (slope, step) in slopes.iter().zip(steps.iter_mut()) {
            let along: f64 =
                slope.iter().zip(offsets.iter()).map(|(a, b)| a.re * b.re + a.im * b.im).sum();
            let square: f64 = slope.iter().map(Complex::norm_sqr).sum();
            let units = libm::round(-along / square);
            if units != 0.0 && units.abs() < 1e6 {
                *step += units;
                *offsets += slope.map(|slope| slope * units);
                moved = true;
            }
        }
        if !moved {
            return;
        }
    }
}

fn worst<const N: usize>(offsets: &SVector<Complex<f64>, N>) -> f64 {
    offsets.iter().map(Complex::norm_sqr).fold(0.0, f64::max)
}

/// The distance from the magnitude of a number to the next double.
fn last_place(value: f64) -> f64 {
    f64::from_bits(value.abs().to_bits() + 1) - value.abs()
}

/// The slopes dλ = −y dL C x, for left and right eigenvectors with y x = 1 on the balanced scale.
fn slopes<const N: usize, const P: usize>(
    problem: &Problem<N, P>,
    checked: &Checked<N, P>,
) -> Option<Slopes<N, P>> {
    let closed = complex(&problem.closed(&checked.gain));
    let outputs = complex(&extend(problem.c));
    let mut slopes = Slopes::<N, P>::from_fn(|_, _| SVector::zeros());
    for pole in 0..N {
        let eigenvalue = extend_complex(checked.placed[pole]);
        let right = eigenvector(&closed, eigenvalue)?;
        let left = eigenvector(&closed.transpose(), eigenvalue)?;
        let product = left
            .iter()
            .zip(right.iter())
            .fold(Complex::from(Extended::from(0.0)), |sum, (&y, &x)| sum + y * x);
        let seen = outputs.times(&problem.pair.unbalanced(&right)).map(round_complex);
        let moved =
            problem.pair.unbalanced_row(&left.map(|value| value / product)).map(round_complex);
        for row in 0..N {
            for column in 0..P {
                let unit = last_place(checked.gain[(row, column)]);
                slopes[(row, column)][pole] =
                    -moved[row] * seen[column] * (unit / problem.reference(problem.poles[pole]));
            }
        }
    }
    let finite = slopes
        .iter()
        .all(|slope| slope.iter().all(|value| value.re.is_finite() && value.im.is_finite()));
    finite.then_some(slopes)
}
