use crate::matrix::{Square, determinant, identity, inverse_of_symmetric, product, times};
use crate::normal::{Inverse, Normal, amplification};
use crate::{Error, Triad};
use kestirim_scalar::{Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// The errors of a magnetometer.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MagnetometerFit<T: Scalar> {
    /// The hard iron as offset, in the magnetometer's unit, and the soft iron as matrix, symmetric, of determinant 1: a
    /// common rotation of all axes cannot be seen on a sphere.
    pub triad: Triad<T>,
    /// The mean field strength of corrected samples, in the magnetometer's unit.
    pub field: T,
    /// The standard deviations of the offset, in the magnetometer's unit.
    pub offset_sigma: [T; 3],
    /// The standard deviations of the matrix.
    pub matrix_sigma: [[T; 3]; 3],
}

/// The number of coefficients of the ellipsoid.
const UNKNOWNS: usize = 9;
/// The largest amplification of noise: for directions more similar than that, rounding outweighs the samples.
const MOST_AMPLIFICATION: f64 = 200.0;
/// The largest standard deviation of the offset, as a share of the field, and of the matrix.
const MOST_SIGMA: f64 = 0.05;

/// The fit of an ellipsoid to the samples of a magnetometer that is turned in all directions, kept as sums of fixed
/// size.
///
/// Least squares of x² + y² + z² = a(x² + y² − 2z²) + b(x² + z² − 2y²) + 2c·xy + 2d·xz + 2e·yz + 2f·x + 2g·y + 2h·z +
/// i: the quadric whose matrix has the trace 3, to which any ellipsoid can be scaled. It is unbiased as long as the
/// noise is small compared with the field.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Magnetometer<T: Scalar> {
    centre: [T; 3],
    radius: T,
    normal: Normal<T, UNKNOWNS>,
    samples: T,
}

impl<T: Scalar> Magnetometer<T> {
    /// Begins with a `centre` and a `radius`, both in the magnetometer's unit: roughly the middle and half the width of
    /// its readings. An error of half the field does no harm.
    ///
    /// The sums are kept relative to these, so that an `f32` can hold them.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::NotPositive`] for the radius.
    pub fn new(centre: SVector<T, 3>, radius: T) -> Result<Self, Error> {
        if !T::all_finite(centre.as_array()) {
            return Err(Error::NotFinite);
        }
        if !(radius.is_finite() && radius > T::ZERO) {
            return Err(Error::NotPositive);
        }
        let centre = *centre.as_array();
        Ok(Self { centre, radius, normal: Normal::new(), samples: T::ZERO })
    }

    /// Adds a sample, in the magnetometer's unit.
    ///
    /// # Errors
    /// [`Error::NotFinite`] for the sample or its sums, [`Error::Full`] where the number type cannot count further;
    /// nothing is changed.
    pub fn add(&mut self, sample: &SVector<T, 3>) -> Result<(), Error> {
        let by = self.radius.divisor();
        let ([x, y, z], [cx, cy, cz]) = (*sample.as_array(), self.centre);
        let [x, y, z] = [x - cx, y - cy, z - cz].map(|component| component.divided_by(by));
        let [xx, yy, zz] = [x * x, y * y, z * z];
        let row = [
            xx + yy - T::TWO * zz,
            xx + zz - T::TWO * yy,
            T::TWO * x * y,
            T::TWO * x * z,
            T::TWO * y * z,
            T::TWO * x,
            T::TWO * y,
            T::TWO * z,
            T::ONE,
        ];
        let samples = self.samples + T::ONE;
        if !samples.is_finite() || samples <= self.samples {
            return Err(Error::Full);
        }
        let mut normal = self.normal;
        normal.add(&row, xx + yy + zz);
        if !normal.is_finite() {
            return Err(Error::NotFinite);
        }
        (self.normal, self.samples) = (normal, samples);
        Ok(())
    }

    /// Solves for the errors of the magnetometer.
    ///
    /// # Errors
    /// [`Error::TooFew`] below twelve samples, [`Error::NotObservable`] if they form no ellipsoid, or too small a part
    /// of one: offset or matrix uncertain by more than 5 % of the field.
    pub fn solve(&self) -> Result<MagnetometerFit<T>, Error> {
        const FEWEST: u16 = 12;
        if self.samples < T::from_f64(f64::from(FEWEST)) {
            // Below twelve, the count is exact in every number type.
            let found = self.samples.to_binary(0).clamp(0, i32::from(u16::MAX)) as u16;
            return Err(Error::TooFew { found, needed: FEWEST });
        }
        let inverse = self.normal.inverse(&[true; UNKNOWNS], T::ZERO);
        let inverse = inverse.ok_or(Error::NotObservable)?;
        let many = self.samples.sqrt();
        let most = T::from_f64(MOST_AMPLIFICATION);
        if !amplification(&inverse).iter().all(|&gain| gain * many <= most) {
            return Err(Error::NotObservable);
        }
        let solution = self.normal.solution(&inverse);
        let best = ellipsoid(&solution).ok_or(Error::NotObservable)?;
        let freedom = self.samples - T::from_f64(UNKNOWNS as f64);
        let noise = (self.normal.left(&solution) / freedom).sqrt();
        let (offset_sigma, matrix_sigma) =
            deviations(&solution, &inverse, noise).ok_or(Error::NotObservable)?;
        let limit = T::from_f64(MOST_SIGMA);
        let is_known = |sigma: &T| *sigma <= limit;
        let relative = offset_sigma.map(|sigma| sigma / best.field);
        if !(relative.iter().all(is_known) && matrix_sigma.iter().flatten().all(is_known)) {
            return Err(Error::NotObservable);
        }
        let back = |offset: [T; 3]| {
            let [x, y, z] = offset.map(|offset| offset * self.radius);
            let [cx, cy, cz] = self.centre;
            SVector::from([x + cx, y + cy, z + cz])
        };
        let triad = Triad { offset: back(best.offset), matrix: SMatrix::from(best.matrix) };
        triad.check()?;
        let fit = MagnetometerFit {
            triad,
            field: best.field * self.radius,
            offset_sigma: offset_sigma.map(|sigma| sigma * self.radius),
            matrix_sigma,
        };
        let finite = fit.field.is_finite() && T::all_finite(&fit.offset_sigma);
        if finite { Ok(fit) } else { Err(Error::NotFinite) }
    }
}

/// An ellipsoid in units of the radius.
struct Ellipsoid<T> {
    offset: [T; 3],
    matrix: Square<T>,
    field: T,
}

/// The ellipsoid of the coefficients, if they describe one.
fn ellipsoid<T: Scalar>([a, b, c, d, e, f, g, h, i]: &[T; UNKNOWNS]) -> Option<Ellipsoid<T>> {
    let (a, b, c, d, e) = (*a, *b, *c, *d, *e);
    // xᵀ Q x − 2 lᵀ x = i.
    let q = [
        [T::ONE - a - b, -c, -d],
        [-c, T::ONE - a + T::TWO * b, -e],
        [-d, -e, T::ONE + T::TWO * a - b],
    ];
    // Sylvester's criterion.
    let minor = q[0][0] * q[1][1] - q[0][1] * q[0][1];
    let whole = determinant(&q);
    if !(q[0][0] > T::ZERO && minor > T::ZERO && whole > T::from_f64(1e-3) && whole.is_finite()) {
        return None;
    }
    let line = [*f, *g, *h];
    let offset = times(&inverse_of_symmetric(&q), &line);
    // (x − o)ᵀ Q (x − o) = i + oᵀ Q o = i + lᵀ o.
    let square = *i + T::dot(&line, &offset);
    let root = root(&q)?;
    // A matrix of determinant 1 preserves the mean of the field: |W (x − o)|² = √²·w², W = root·w, w³ = 1/det(root).
    let third = determinant(&root).ln() * T::from_f64(-1.0 / 3.0);
    let scale = third.exp();
    let matrix = root.map(|column| column.map(|entry| entry * scale));
    let field = square.sqrt() * scale;
    let finite = field.is_finite()
        && field > T::ZERO
        && T::all_finite(&offset)
        && T::all_finite(matrix.as_flattened());
    finite.then_some(Ellipsoid { offset, matrix, field })
}

/// The symmetric square root of a positive definite matrix whose trace is 3, by the iteration of Denman & Beavers
/// (1976).
fn root<T: Scalar>(square: &Square<T>) -> Option<Square<T>> {
    const STEPS: u16 = 12;
    let (mut root, mut inverse): (Square<T>, Square<T>) = (*square, identity());
    let mean = |a: &Square<T>, b: &Square<T>| {
        let mut mean = *a;
        for (entry, &other) in mean.as_flattened_mut().iter_mut().zip(b.as_flattened()) {
            *entry = (*entry + other) * T::HALF;
        }
        mean
    };
    for _ in 0..STEPS {
        let next = mean(&root, &inverse_of_symmetric(&inverse));
        inverse = mean(&inverse, &inverse_of_symmetric(&root));
        root = next;
    }
    let again = product(&root, &root);
    let off = again.as_flattened().iter().zip(square.as_flattened());
    let is_root = off.fold(true, |all, (&a, &b)| all && (a - b).abs() <= T::from_f64(1e-4));
    is_root.then_some(root)
}

/// The standard deviations of offset and matrix, from points on either side of the solution along the columns of the
/// covariance's square root; `None` if one of the points is no ellipsoid.
fn deviations<T: Scalar>(
    solution: &[T; UNKNOWNS],
    inverse: &Inverse<T, UNKNOWNS>,
    noise: T,
) -> Option<([T; 3], Square<T>)> {
    let (mut offset, mut matrix) = ([T::ZERO; 3], [[T::ZERO; 3]; 3]);
    // Smaller steps drown in rounding; the result is proportional to the step.
    let step = noise.max(T::from_f64(1e-3));
    let share = noise / (step + step);
    let mut rest = *inverse;
    for pivot in 0..UNKNOWNS {
        // The Cholesky factor, column by column.
        let line = *rest.get(pivot)?;
        let diagonal = *line.get(pivot)?;
        if diagonal <= T::ZERO {
            continue;
        }
        let length = diagonal.sqrt();
        let column = line.map(|entry| entry / length);
        for (other, &own) in rest.iter_mut().zip(&column) {
            for (entry, &by) in other.iter_mut().zip(&column) {
                *entry -= own * by;
            }
        }
        let side = |by: T| {
            let mut moved = *solution;
            for (entry, &column) in moved.iter_mut().zip(&column) {
                *entry += column * by;
            }
            ellipsoid(&moved)
        };
        let (above, below) = (side(step)?, side(-step)?);
        let add = |sums: &mut [T], above: &[T], below: &[T]| {
            for ((sum, &above), &below) in sums.iter_mut().zip(above).zip(below) {
                let difference = (above - below) * share;
                *sum += difference * difference;
            }
        };
        add(&mut offset, &above.offset, &below.offset);
        let (above, below) = (above.matrix, below.matrix);
        add(matrix.as_flattened_mut(), above.as_flattened(), below.as_flattened());
    }
    let roots = (offset.map(T::sqrt), matrix.map(|column| column.map(T::sqrt)));
    let finite = T::all_finite(&roots.0) && T::all_finite(roots.1.as_flattened());
    finite.then_some(roots)
}
