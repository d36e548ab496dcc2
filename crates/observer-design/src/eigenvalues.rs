//! Eigenvalues by the shifted QR algorithm.

use core::ops::Range;

use crate::Error;
use crate::extended::{EPSILON, Extended};
use crate::number::{
    Number, Real, Square, complex, extend, finite, norm, power_of_two, round_complex, shifted,
};
use crate::orthonormal::{normalised, oblique};
use crate::solve::Eliminated;
use kestirim_scalar::Columns;
use nalgebra::{Complex, SMatrix, SVector};

type Wide = Complex<Extended>;

/// Limit on the QR steps for a single eigenvalue.
const MOST_STEPS: u32 = 200;

/// The eigenvalues of a matrix, computed with 106 bits.
///
/// They are correct to the last place of a double even where they lie so close together that a computation in doubles
/// would keep no digit.
///
/// # Errors
/// [`Error::NotFinite`] or [`Error::NotConverged`].
pub fn eigenvalues<const N: usize>(
    matrix: &SMatrix<f64, N, N>,
) -> Result<[Complex<f64>; N], Error> {
    if !finite(matrix) {
        return Err(Error::NotFinite);
    }
    Ok(eigenvalues_extended(&extend(matrix))?.map(round_complex))
}

/// The eigenvalues of a real matrix of 106 bits: real ones, and pairs that are conjugate to the last bit.
pub(crate) fn eigenvalues_extended<const N: usize>(
    matrix: &Square<Extended, N>,
) -> Result<[Wide; N], Error> {
    let mut values = spectrum(&complex(matrix))?;
    let mut done = [false; N];
    for index in 0..N {
        if done[index] {
            continue;
        }
        let conjugate = values[index].conjugate();
        let distance = |other: &Wide| (*other - conjugate).magnitude();
        let others = values.iter_mut().zip(&mut done).skip(index).filter(|(_, done)| !**done);
        if let Some((partner, done)) =
            others.min_by(|(a, _), (b, _)| distance(a).total_cmp(&distance(b)))
        {
            let mean = (*partner + conjugate).scaled(Extended::from(0.5));
            (*partner, *done) = (mean, true);
            values[index] = mean.conjugate();
        }
    }
    Ok(values)
}

/// An eigenvector of length 1, by inverse iteration slightly beside its eigenvalue.
pub(crate) fn eigenvector<const N: usize>(
    matrix: &Square<Wide, N>,
    eigenvalue: Wide,
) -> Option<SVector<Wide, N>> {
    // Exactly at the eigenvalue, the matrix would be singular.
    let beside = eigenvalue + Complex::from(Extended::from(1e-24));
    let distance = Eliminated::new(&shifted(matrix, beside))?;
    let mut vector = oblique();
    for _ in 0..3 {
        vector = normalised(&distance.solve(&vector), 0.0)?;
    }
    Some(vector)
}

fn spectrum<const N: usize>(matrix: &Square<Wide, N>) -> Result<[Wide; N], Error> {
    // Scaled by a power of two, so that no square overflows or underflows.
    let scale = power_of_two(norm(matrix));
    let mut h = matrix.map(|value| value.scaled(Extended::from(1.0 / scale)));
    reduce(&mut h);
    let tiny = norm(&h) * EPSILON * EPSILON;
    for end in (2..=N).rev() {
        let mut steps = 0;
        loop {
            let start = decoupled(&mut h, end, tiny);
            if start + 1 == end {
                break;
            }
            if steps == MOST_STEPS || !element(&h, end - 1, end - 1).magnitude().is_finite() {
                return Err(Error::NotConverged);
            }
            steps += 1;
            // An occasional exceptional shift breaks cycles.
            let shift = if steps % 15 == 0 {
                let beside = element(&h, end - 1, end - 2).magnitude();
                element(&h, end - 1, end - 1) + Complex::from(Extended::from(beside))
            } else {
                wilkinson(&h, end)
            };
            step(&mut h, start, end, shift);
        }
    }
    let mut values = [Complex::from(Extended::from(0.0)); N];
    for (index, value) in values.iter_mut().enumerate() {
        *value = element(&h, index, index).scaled(Extended::from(scale));
    }
    Ok(values)
}

/// An element of a matrix; zero outside of it.
fn element<T: Number, const N: usize>(h: &Square<T, N>, row: usize, column: usize) -> T {
    h.get((row, column)).copied().unwrap_or(T::zero())
}

fn clear<T: Number, const N: usize>(h: &mut Square<T, N>, row: usize, column: usize) {
    if let Some(place) = h.get_mut((row, column)) {
        *place = T::zero();
    }
}

/// A unitary plane rotation that turns (a, b) into (r, 0).
struct Rotation {
    cosine: Wide,
    sine: Wide,
}

impl Rotation {
    fn new(a: Wide, b: Wide) -> Self {
        let length = (a.squared() + b.squared()).square_root();
        if length.rounded() == 0.0 {
            return Self {
                cosine: Complex::from(Extended::from(1.0)),
                sine: Complex::from(Extended::from(0.0)),
            };
        }
        let reciprocal = Extended::from(1.0) / length;
        Self { cosine: a.scaled(reciprocal), sine: b.scaled(reciprocal) }
    }

    /// Rotates rows `first` and `second`, from column `from` on.
    fn turn_rows<const N: usize>(
        &self,
        h: &mut Square<Wide, N>,
        [first, second]: [usize; 2],
        from: usize,
    ) {
        for column in h.as_columns_mut().iter_mut().skip(from) {
            if let Ok([a, b]) = column.get_disjoint_mut([first, second]) {
                (*a, *b) = (
                    self.cosine.conjugate() * *a + self.sine.conjugate() * *b,
                    self.cosine * *b - self.sine * *a,
                );
            }
        }
    }

    /// Rotates columns `first` and `second` inversely, above row `to`, so that both rotations form a similarity
    /// transform.
    fn turn_columns<const N: usize>(
        &self,
        h: &mut Square<Wide, N>,
        [first, second]: [usize; 2],
        to: usize,
    ) {
        let Ok([first, second]) = h.as_columns_mut().get_disjoint_mut([first, second]) else {
            return;
        };
        for (a, b) in first.iter_mut().zip(second).take(to) {
            (*a, *b) = (
                *a * self.cosine + *b * self.sine,
                *b * self.cosine.conjugate() - *a * self.sine.conjugate(),
            );
        }
    }
}

/// Reduces a matrix, by similarity transforms, to Hessenberg form.
fn reduce<const N: usize>(h: &mut Square<Wide, N>) {
    for column in 0..N.saturating_sub(2) {
        for row in (column + 2..N).rev() {
            let rotation = Rotation::new(element(h, row - 1, column), element(h, row, column));
            rotation.turn_rows(h, [row - 1, row], column);
            rotation.turn_columns(h, [row - 1, row], N);
            clear(h, row, column);
        }
    }
}

/// The first row of the last block, which no negligible subdiagonal element divides.
fn decoupled<const N: usize>(h: &mut Square<Wide, N>, end: usize, tiny: f64) -> usize {
    for row in (1..end).rev() {
        let size = |row, column| element(h, row, column).magnitude();
        let beside = size(row - 1, row - 1) + size(row, row);
        if size(row, row - 1) <= EPSILON * beside + tiny {
            clear(h, row, row - 1);
            return row;
        }
    }
    0
}

/// The eigenvalue of the last 2 × 2 block that is nearer to its last element. Double precision suffices: the shift
/// only speeds up convergence.
fn wilkinson<const N: usize>(h: &Square<Wide, N>, end: usize) -> Wide {
    let last = |row, column| round_complex(element(h, end - row, end - column));
    let half_difference = (last(2, 2) - last(1, 1)) * 0.5;
    let root = square_root(half_difference * half_difference + last(2, 1) * last(1, 2));
    let same_side = (half_difference.conjugate() * root).re >= 0.0;
    let sum = if same_side { half_difference + root } else { half_difference - root };
    if sum.magnitude() == 0.0 {
        return element(h, end - 1, end - 1);
    }
    let shift = last(1, 1) - last(2, 1) * last(1, 2) / sum;
    Complex { re: Extended::from(shift.re), im: Extended::from(shift.im) }
}

fn square_root(value: Complex<f64>) -> Complex<f64> {
    let modulus = value.magnitude();
    let re = libm::sqrt((0.5 * (modulus + value.re)).max(0.0));
    let im = libm::sqrt((0.5 * (modulus - value.re)).max(0.0));
    Complex { re, im: if value.im < 0.0 { -im } else { im } }
}

/// Makes one QR step with a shift, on the block from `start` to `end`.
fn step<const N: usize>(h: &mut Square<Wide, N>, start: usize, end: usize, shift: Wide) {
    move_diagonal(h, start..end, -shift);
    let mut waiting: Option<(Rotation, usize)> = None;
    for row in start..end - 1 {
        let rotation = Rotation::new(element(h, row, row), element(h, row + 1, row));
        rotation.turn_rows(h, [row, row + 1], row);
        if let Some((previous, at)) = waiting.replace((rotation, row)) {
            previous.turn_columns(h, [at, at + 1], at + 2);
        }
    }
    if let Some((last, at)) = waiting {
        last.turn_columns(h, [at, at + 1], end);
    }
    move_diagonal(h, start..end, shift);
}

fn move_diagonal<T: Number, const N: usize>(h: &mut Square<T, N>, places: Range<usize>, by: T) {
    for place in places {
        if let Some(element) = h.get_mut((place, place)) {
            *element += by;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix4, SMatrix};

    fn sorted<const N: usize>(mut values: [Complex<f64>; N]) -> [Complex<f64>; N] {
        values.sort_by(|a, b| a.re.total_cmp(&b.re).then(a.im.total_cmp(&b.im)));
        values
    }

    #[test]
    fn a_companion_matrix_has_the_roots_of_its_polynomial() {
        // The polynomial (s + 1)(s + 2)(s² + 2 s + 5).
        let companion = Matrix4::new(
            0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, -10.0, -19.0, -13.0, -5.0,
        );
        let expected = [(-2.0, 0.0), (-1.0, -2.0), (-1.0, 0.0), (-1.0, 2.0)];
        let values = sorted(eigenvalues(&companion).unwrap());
        for (value, (re, im)) in values.iter().zip(expected) {
            assert!((value - Complex::new(re, im)).norm_sqr() < 1e-60, "{value}");
        }
    }

    #[test]
    fn a_rotation_by_a_permutation_converges() {
        let mut cycle = SMatrix::<f64, 5, 5>::zeros();
        for index in 0..5 {
            cycle[(index, (index + 1) % 5)] = 1.0;
        }
        for value in eigenvalues(&cycle).unwrap() {
            assert!((value.norm_sqr() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn close_eigenvalues_keep_their_digits() {
        // A Jordan block with a perturbed corner: λ = 1 + 1e-5 · fourth roots of one.
        let mut matrix = Matrix4::<f64>::identity();
        for index in 0..3 {
            matrix[(index, index + 1)] = 1.0;
        }
        matrix[(3, 0)] = 1e-20;
        for value in eigenvalues(&matrix).unwrap() {
            let distance = libm::hypot(value.re - 1.0, value.im);
            assert!((distance / 1e-5 - 1.0).abs() < 1e-10, "{value}");
        }
    }

    #[test]
    fn nothing_finite_is_refused() {
        assert_eq!(eigenvalues(&Matrix4::repeat(f64::NAN)), Err(Error::NotFinite));
    }
}
