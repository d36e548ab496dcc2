//! Placement with one output, where the gain is unique.

use crate::extended::Extended;
use crate::number::{Square, Times, norm};
use crate::orthonormal::{inner, length, normalised};
use crate::pair::Pair;
use crate::sequence::Sequence;
use kestirim_scalar::{Columns, Components};
use nalgebra::{Complex, SVector};

/// The gain from the first output of (A, S), in the first column.
///
/// In an orthonormal basis of cᵀ, Aᵀ cᵀ, … (Arnoldi's), Aᵀ is a Hessenberg matrix H with subdiagonal h, cᵀ is
/// β e₁, and the gain is the last row of φ(H) over β h₁ h₂ …, where φ is the wanted characteristic polynomial:
/// Ackermann's formula without the powers of A.
pub(crate) fn place<const N: usize>(
    dynamics: &Square<Extended, N>,
    outputs: &Square<Extended, N>,
    poles: &[Complex<f64>; N],
) -> Option<Square<Extended, N>> {
    let transposed = dynamics.transpose();
    let first = outputs.row(0).transpose();
    let mut basis = Square::<Extended, N>::zeros();
    let mut hessenberg = Square::<Extended, N>::zeros();
    let mut product = length(&first);
    let mut direction = normalised(&first, 0.0)?;
    for column in 0..N {
        basis.as_columns_mut()[column] = *direction.as_array();
        let mut vector = transposed.times(&direction);
        // Projected twice, because one projection leaves rounding behind.
        for _ in 0..2 {
            let parts = &mut hessenberg.as_columns_mut()[column];
            for (&base, sum) in basis.as_columns().iter().zip(parts).take(column + 1) {
                let base = SVector::from(base);
                let part = inner(&base, &vector);
                vector -= base * part;
                *sum += part;
            }
        }
        if column + 1 < N {
            let next = length(&vector);
            product *= next;
            hessenberg[(column + 1, column)] = next;
            direction = normalised(&vector, 0.0)?;
        }
    }
    let mut gain = Square::<Extended, N>::zeros();
    let reciprocal = Extended::from(1.0) / product;
    let row = basis.times(&last_row(&hessenberg, poles));
    gain.set_column(0, &row.map(|value| value * reciprocal));
    Some(gain)
}

/// The last row of φ(H), as a column. Complex poles must have their conjugates next to them.
fn last_row<const N: usize>(
    hessenberg: &Square<Extended, N>,
    poles: &[Complex<f64>; N],
) -> SVector<Extended, N> {
    let transposed = hessenberg.transpose();
    let times = |vector: &SVector<Extended, N>, re: f64| {
        let re = Extended::from(re);
        transposed.times(vector) - vector.map(|value| value * re)
    };
    let mut row = SVector::<Extended, N>::zeros();
    if let Some(last) = row.iter_mut().last() {
        *last = Extended::from(1.0);
    }
    let mut skip = false;
    for pole in poles {
        if core::mem::take(&mut skip) {
            continue;
        }
        let once = times(&row, pole.re);
        row = if pole.im == 0.0 {
            once
        } else {
            // (H − λ)(H − λ*) = (H − Re λ)² + (Im λ)²
            skip = true;
            let square = Extended::from(pole.im) * Extended::from(pole.im);
            times(&once, pole.re) + row.map(|value| value * square)
        };
    }
    row
}

/// The gain of a pair with several outputs that acts through a mixture of them, after a first gain that makes
/// the modes distinct and all visible in the mixture.
pub(crate) fn through_a_mixture<const N: usize>(
    pair: &Pair<N>,
    poles: &[Complex<f64>; N],
    attempt: u32,
) -> Option<Square<Extended, N>> {
    let mut random = Sequence::new(attempt);
    let mut first = Square::<Extended, N>::zeros();
    let mut mixture = SVector::<Extended, N>::zeros();
    let size = if attempt == 0 { 0.0 } else { norm(&pair.dynamics) / pair.outputs_norm() };
    for (weight, mut column) in mixture.iter_mut().zip(first.column_iter_mut()).take(pair.rank) {
        *weight = Extended::from(random.next());
        column.apply(|value| *value = Extended::from(size * random.next()));
    }
    let dynamics = pair.dynamics - first.times(&pair.outputs);
    let mut output = Square::<Extended, N>::zeros();
    output.set_row(0, &(mixture.transpose().times(&pair.outputs)));
    let gain = place(&dynamics, &output, poles)?;
    Some(first + gain.column(0) * mixture.transpose())
}
