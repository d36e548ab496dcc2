use kestirim_arithmetic::vectors::Kernel;
use kestirim_scalar::Scalar;

use crate::blocks::{BLOCK, Points, on_vectors};
use crate::weights::{Weights, never};

/// Weighted mean and covariance of a set of points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "T: serde::Serialize")))]
pub struct Moments<T, const D: usize> {
    #[cfg_attr(feature = "serde", serde(serialize_with = "kestirim_snapshot::arrays::serialize"))]
    mean: [T; D],
    /// Lower triangular F with F·Fᵀ the covariance: in the unit of the state, as a square of metres might
    /// not fit into fixed point.
    #[cfg_attr(
        feature = "serde",
        serde(serialize_with = "kestirim_snapshot::arrays::rows::serialize")
    )]
    factor: [[T; D]; D],
}

impl<T: Scalar, const D: usize> Moments<T, D> {
    /// Moments of weighted points, computed on the widest vectors of the processor.
    #[inline(always)]
    pub(crate) fn of<const N: usize>(weights: &Weights<T, N>, points: &impl Points<T, D>) -> Self {
        on_vectors::<T, _>(Looking { weights, points })
    }

    #[inline(always)]
    fn looked<const N: usize>(weights: &Weights<T, N>, points: &impl Points<T, D>) -> Self {
        let share = weights.sum().recip();
        let (centre, reach) = extent(weights, points);
        let mean = mean(weights, points, centre);
        // Computed in units of the sides of the bounding box, so that no square overflows.
        let unit = reach.map(|reach| (reach + reach).max(T::EPSILON).divisor());
        let mut factor = weights.sums(points, |weight, point| {
            let mut pairs = [[(T::ZERO, T::ZERO); D]; D];
            let mut from_mean = [T::ZERO; D];
            for row in 0..D {
                from_mean[row] = (point[row] - mean[row]).divided_by(unit[row]);
                for column in 0..=row {
                    pairs[row][column] = (from_mean[row] * (weight * share), from_mean[column]);
                }
            }
            pairs
        });
        cholesky(&mut factor);
        for row in 0..D {
            for column in 0..=row {
                factor[row][column] *= reach[row] + reach[row];
            }
        }
        Self { mean, factor }
    }

    /// The weighted mean.
    #[inline(always)]
    pub fn mean(&self) -> [T; D] {
        self.mean
    }

    /// A lower triangular matrix F (rows first) with F·Fᵀ the covariance.
    #[inline(always)]
    pub fn factor(&self) -> &[[T; D]; D] {
        &self.factor
    }

    /// Standard deviation of each coordinate.
    #[inline]
    pub fn deviation(&self) -> [T; D] {
        self.factor.map(|row| T::norm(&row))
    }

    /// √(trace of the covariance): the root mean square distance from the mean.
    #[inline]
    pub fn spread(&self) -> T {
        T::norm(&self.deviation())
    }

    /// The covariance matrix, rows first. In fixed point, an entry whose square does not fit saturates:
    /// use [`Moments::factor`] there.
    #[inline]
    pub fn covariance(&self) -> [[T; D]; D] {
        let mut covariance = [[T::ZERO; D]; D];
        for row in 0..D {
            for column in 0..D {
                covariance[row][column] = T::dot(&self.factor[row], &self.factor[column]);
            }
        }
        covariance
    }
}

/// The computation of moments, as a kernel for vectors.
pub(crate) struct Looking<'a, T, P, const D: usize, const N: usize> {
    pub(crate) weights: &'a Weights<T, N>,
    pub(crate) points: &'a P,
}

impl<T: Scalar, P: Points<T, D>, const D: usize, const N: usize> Kernel
    for Looking<'_, T, P, D, N>
{
    type Output = Moments<T, D>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        Moments::looked(self.weights, self.points)
    }
}

/// The weighted mean, summed relative to a point among the others, so that sums of large coordinates neither overflow
/// nor lose precision.
#[inline(always)]
pub(crate) fn mean<T: Scalar, const D: usize, const N: usize>(
    weights: &Weights<T, N>,
    points: &impl Points<T, D>,
    centre: [T; D],
) -> [T; D] {
    let share = weights.sum().recip();
    let [offset] = weights.sums(points, |weight, point| {
        let mut pairs = [(weight * share, T::ZERO); D];
        for axis in 0..D {
            pairs[axis].1 = point[axis] - centre[axis];
        }
        [pairs]
    });
    let mut mean = centre;
    for axis in 0..D {
        mean[axis] += offset[axis];
    }
    mean
}

/// The centre of the bounding box of all points with nonzero weight, and half of its sides.
#[inline(always)]
fn extent<T: Scalar, const D: usize, const N: usize>(
    weights: &Weights<T, N>,
    points: &impl Points<T, D>,
) -> ([T; D], [T; D]) {
    let never = never::<T>();
    let (low, high) = bounds(weights, points, |log| log > never);
    let (mut centre, mut reach) = ([T::ZERO; D], [T::ZERO; D]);
    for axis in 0..D {
        // Halved first: the sum of two large coordinates would overflow.
        centre[axis] = low[axis] * T::HALF + high[axis] * T::HALF;
        reach[axis] = high[axis] * T::HALF - low[axis] * T::HALF;
    }
    (centre, reach)
}

/// The bounding box, as its two corners, of the points whose logarithmic weight is `wanted`.
#[inline(always)]
pub(crate) fn bounds<T: Scalar, const D: usize, const N: usize>(
    weights: &Weights<T, N>,
    points: &impl Points<T, D>,
    wanted: impl Fn(T) -> bool,
) -> ([T; D], [T; D]) {
    let (mut low, mut high) = ([[T::MAX; BLOCK]; D], [[T::MIN; BLOCK]; D]);
    let mut room = [[T::ZERO; BLOCK]; D];
    let mut base = 0;
    while let Some(logs) = weights.block(base) {
        let block = points.load(base, logs.len(), &mut room);
        for axis in 0..D {
            for (index, &log) in (0..BLOCK).zip(logs) {
                let value = block[axis][index];
                let inside = wanted(log);
                low[axis][index] = low[axis][index].min(if inside { value } else { T::MAX });
                high[axis][index] = high[axis][index].max(if inside { value } else { T::MIN });
            }
        }
        base += BLOCK;
    }
    (
        low.map(|lanes| lanes.into_iter().fold(T::MAX, T::min)),
        high.map(|lanes| lanes.into_iter().fold(T::MIN, T::max)),
    )
}

/// Cholesky factorisation of the lower triangle, in place. A column whose pivot is not positive becomes zero: the
/// points then lie in a subspace of fewer dimensions.
#[inline(always)]
fn cholesky<T: Scalar, const D: usize>(matrix: &mut [[T; D]; D]) {
    for column in 0..D {
        for row in column..D {
            for before in 0..column {
                let product = matrix[row][before] * matrix[column][before];
                matrix[row][column] -= product;
            }
        }
        let pivot = matrix[column][column].max(T::ZERO).sqrt();
        let divisor = pivot.max(T::EPSILON).divisor();
        matrix[column][column] = pivot;
        for row in column + 1..D {
            let entry = matrix[row][column].divided_by(divisor);
            matrix[row][column] = if pivot > T::ZERO { entry } else { T::ZERO };
        }
    }
}
