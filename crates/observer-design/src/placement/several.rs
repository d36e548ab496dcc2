//! Placement with several outputs, where eigenvectors can be chosen.

use crate::extended::Extended;
use crate::number::{
    Number, Square, Times, adjoint, complex, extend_complex, norm, round_complex, shifted,
};
use crate::orthonormal::{complete, normalised};
use crate::pair::Pair;
use crate::sequence::Sequence;
use crate::solve::{inverse, solve};
use kestirim_scalar::{Columns, Components};
use nalgebra::{Complex, SVector};

type Wide = Complex<Extended>;
type Narrow = Complex<f64>;

/// Number of random starts of the choice of eigenvectors, and limit on the sweeps over all vectors from each.
const STARTS: u32 = 8;
const SWEEPS: u32 = 24;

/// A gain for the balanced pair, in the first columns. `poles` has the real ones first, and pairs side by side.
///
/// Computed for the dual, F = Aᵀ and B = Sᵀ: (F − λ) x = B g makes x an eigenvector of
/// F − B K, with K = G X⁻¹.
pub(crate) fn place<const N: usize>(
    pair: &Pair<N>,
    poles: &[Narrow; N],
) -> Option<Square<Extended, N>> {
    let transposed = complex(&pair.dynamics.transpose());
    let inputs = complex(&pair.outputs.transpose());
    let range = complete(&inputs, pair.rank)?;

    let mut spaces = [Square::<Wide, N>::zeros(); N];
    for (space, &pole) in spaces.iter_mut().zip(poles) {
        *space = eigenvectors(&shifted(&transposed, extend_complex(pole)), &range, pair.rank)?;
    }
    let vectors = insensitive(&spaces, pair, poles)?;

    // With B = U R, where U is the first columns of `range`: g = R⁻¹ Uᴴ (F − λ) x.
    let mut triangle = adjoint(&range).times(&inputs);
    for index in pair.rank..N {
        triangle[(index, index)] = Wide::from(Extended::from(1.0));
    }
    let mut wanted = Square::<Wide, N>::zeros();
    let mut exact = Square::<Wide, N>::zeros();
    for index in 0..N {
        let (space, pole) = (&spaces[index], extend_complex(poles[index]));
        let vector = vectors.column(index).map(extend_complex);
        let vector = normalised(&(space.times(&adjoint(space).times(&vector))), 0.0)?;
        let image = adjoint(&range).times(&shifted(&transposed, pole).times(&vector));
        exact.set_column(index, &vector);
        wanted.set_column(index, &image);
    }
    for row in pair.rank..N {
        wanted.row_mut(row).fill(Wide::from(Extended::from(0.0)));
    }
    let directions = solve(&triangle, &wanted)?;
    // K X = G, transposed, as L = Kᵀ.
    Some(solve(&exact.transpose(), &directions.transpose())?.map(|value| value.re))
}

/// The space of admissible eigenvectors, in the first `rank` columns: the vectors that F − λ maps into the
/// range of B.
fn eigenvectors<const N: usize>(
    distance: &Square<Wide, N>,
    range: &Square<Wide, N>,
    rank: usize,
) -> Option<Square<Wide, N>> {
    let mut conditions = Square::<Wide, N>::zeros();
    let outside = range.as_columns().iter().skip(rank);
    for (condition, &direction) in conditions.as_columns_mut().iter_mut().zip(outside) {
        *condition = *adjoint(distance).times(&SVector::from(direction)).as_array();
    }
    let basis = complete(&conditions, N - rank)?;
    let mut space = Square::<Wide, N>::zeros();
    for (vector, free) in
        space.as_columns_mut().iter_mut().zip(basis.as_columns().iter().skip(N - rank))
    {
        *vector = *free;
    }
    Some(space)
}

/// Chooses a vector of each space such that the poles are as insensitive as possible. Doubles suffice for the choice.
fn insensitive<const N: usize>(
    spaces: &[Square<Wide, N>; N],
    pair: &Pair<N>,
    poles: &[Narrow; N],
) -> Option<Square<Narrow, N>> {
    let spaces = spaces.map(|space| space.map(round_complex));
    let mut best: Option<(f64, Square<Narrow, N>)> = None;
    for start in 0..STARTS {
        let Some(mut vectors) = anywhere(&spaces, pair.rank, poles, start) else { continue };
        let mut inverted = inverse(&vectors);
        for _ in 0..SWEEPS {
            let Some(current) = inverted else { break };
            // How far a change of A or L can move a pole.
            let sensitivity = norm(&current.transpose());
            if !sensitivity.is_finite() {
                break;
            }
            let improved = best.as_ref().is_none_or(|(least, _)| sensitivity < *least);
            if improved {
                best = Some((sensitivity, vectors));
            }
            inverted = sweep(&mut vectors, current, &spaces, poles);
        }
    }
    best.map(|(_, vectors)| vectors)
}

/// A random vector of each space; real for a real pole, conjugate for conjugate poles.
fn anywhere<const N: usize>(
    spaces: &[Square<Narrow, N>; N],
    rank: usize,
    poles: &[Narrow; N],
    seed: u32,
) -> Option<Square<Narrow, N>> {
    let mut random = Sequence::new(seed);
    let mut vectors = Square::<Narrow, N>::zeros();
    for index in 0..N {
        let real = poles[index].im == 0.0;
        let mut mixture = SVector::<Narrow, N>::zeros();
        for weight in mixture.iter_mut().take(rank) {
            *weight = Complex { re: random.next(), im: if real { 0.0 } else { random.next() } };
        }
        let vector = normalised(&(spaces[index].times(&mixture)), 0.0)?;
        set(&mut vectors, index, &vector, poles);
    }
    Some(vectors)
}

/// Turns every vector, within its space, as far as possible from the plane of all others. Takes and returns
/// the inverse of the matrix of vectors.
fn sweep<const N: usize>(
    vectors: &mut Square<Narrow, N>,
    mut inverted: Square<Narrow, N>,
    spaces: &[Square<Narrow, N>; N],
    poles: &[Narrow; N],
) -> Option<Square<Narrow, N>> {
    for index in 0..N {
        if is_second(index, poles) {
            continue;
        }
        let normal = inverted.row(index).map(Number::conjugate).transpose();
        let projected = spaces[index].times(&adjoint(&spaces[index]).times(&normal));
        set(vectors, index, &normalised(&projected, 0.0)?, poles);
        inverted = inverse(vectors)?;
    }
    Some(inverted)
}

/// Sets the vector of a pole, and its conjugate for a pair; does nothing for the second pole of a pair.
fn set<const N: usize>(
    vectors: &mut Square<Narrow, N>,
    index: usize,
    vector: &SVector<Narrow, N>,
    poles: &[Narrow; N],
) {
    if is_second(index, poles) {
        return;
    }
    let mut columns = vectors.as_columns_mut().iter_mut().skip(index);
    if let Some(first) = columns.next() {
        *first = *vector.as_array();
    }
    if is_second(index + 1, poles)
        && let Some(second) = columns.next()
    {
        *second = *vector.map(Number::conjugate).as_array();
    }
}

/// Whether a pole is the second of a conjugate pair: at an odd position among the complex poles, which come last.
fn is_second<const N: usize>(index: usize, poles: &[Narrow; N]) -> bool {
    poles.get(index).is_some_and(|pole| pole.im != 0.0)
        && poles.iter().take(index).filter(|pole| pole.im != 0.0).count() % 2 == 1
}
