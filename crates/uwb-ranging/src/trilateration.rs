use crate::symmetric::NormalEquations;
use crate::{Error, Observation};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// Linear trilateration (the paper's eqs 3–7): the first anchor's sphere is subtracted from the others', and the
/// pseudo-inverse, which depends on the anchors alone, is computed once.
///
/// With D = 2 the tag is at a known height. Noise of the first anchor enters every equation, and there is no
/// weighting: [`Solver`](crate::Solver) is more accurate by a tenth to a third; this is faster, and provides a
/// start.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Trilateration<T: Scalar, const A: usize, const D: usize> {
    anchors: [SVector<T, 3>; A],
    /// (MᵀM)⁻¹Mᵀ for the rows 2(aᵢ − a₀); the column of the first anchor is zero.
    pseudo_inverse: [[T; A]; D],
}

impl<T: Scalar, const A: usize, const D: usize> Trilateration<T, A, D> {
    /// Precomputes the pseudo-inverse for anchors at these positions (room frame, m).
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::TooFewRanges`] for fewer than D + 1 anchors, or [`Error::DegenerateGeometry`]
    /// if they are collinear (D = 2) or coplanar (D = 3).
    pub fn new(anchors: [SVector<T, 3>; A]) -> Result<Self, Error> {
        const { assert!(0 < D && D <= 3, "a position has up to three coordinates") };
        let Some(&first) = anchors.first().filter(|_| A > D) else {
            return Err(Error::TooFewRanges);
        };
        if !anchors.iter().flat_map(|anchor| anchor.iter()).all(|entry| entry.is_finite()) {
            return Err(Error::NotFinite);
        }
        let mut equations = NormalEquations::new();
        for anchor in &anchors {
            equations.add(&row::<T, D>(anchor, &first), T::ZERO, T::ONE);
        }
        let factors = equations.factorised().ok_or(Error::DegenerateGeometry)?;
        let mut pseudo_inverse = [[T::ZERO; A]; D];
        for (index, anchor) in anchors.iter().enumerate() {
            let column = factors.solve(&row::<T, D>(anchor, &first));
            for (line, entry) in pseudo_inverse.iter_mut().zip(column) {
                line[index] = entry;
            }
        }
        Ok(Self { anchors, pseudo_inverse })
    }

    /// The tag's position (m) from these ranges (m); `height` (m) is not used in three dimensions.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn position(&self, ranges: &[T; A], height: T) -> Result<SVector<T, D>, Error> {
        let (Some(first), Some(&first_range)) = (self.anchors.first(), ranges.first()) else {
            return Err(Error::TooFewRanges);
        };
        let mut position = SVector::<T, D>::from_fn(|axis, _| first.as_array()[axis]);
        let mut right = [T::ZERO; A];
        for ((right, anchor), &range) in right.iter_mut().zip(&self.anchors).zip(ranges) {
            *right = right_side::<T, D>((first, first_range), (anchor, range), height);
        }
        if !T::all_finite(&right) {
            return Err(Error::NotFinite);
        }
        for (coordinate, line) in position.iter_mut().zip(&self.pseudo_inverse) {
            *coordinate = moved(*coordinate, T::dot(line, &right))?;
        }
        Ok(position)
    }
}

/// Linear trilateration as by [`Trilateration`], for a set of anchors that is not known in advance, so that nothing
/// can be precomputed. Variances are not used.
///
/// # Errors
/// Those of [`Trilateration::new`] and [`Trilateration::position`].
pub fn trilaterate<T: Scalar, const D: usize>(
    observations: &[Observation<T>],
    height: T,
) -> Result<SVector<T, D>, Error> {
    const { assert!(0 < D && D <= 3, "a position has up to three coordinates") };
    let Some(first) = observations.first().filter(|_| observations.len() > D) else {
        return Err(Error::TooFewRanges);
    };
    let mut equations = NormalEquations::new();
    for observation in observations {
        if !observation.anchor.iter().all(|entry| entry.is_finite()) {
            return Err(Error::NotFinite);
        }
        equations.add(&row::<T, D>(&observation.anchor, &first.anchor), T::ZERO, T::ONE);
    }
    let factors = equations.factorised().ok_or(Error::DegenerateGeometry)?;
    let mut sums: [_; D] = core::array::from_fn(|_| T::accumulator());
    for observation in observations {
        let column = factors.solve(&row::<T, D>(&observation.anchor, &first.anchor));
        let other = (&observation.anchor, observation.range);
        let right = right_side::<T, D>((&first.anchor, first.range), other, height);
        if !right.is_finite() {
            return Err(Error::NotFinite);
        }
        sums = core::array::from_fn(|axis| T::mac(sums[axis], column[axis], right));
    }
    let place = first.anchor.as_array();
    let mut position = SVector::<T, D>::zeros();
    for (axis, coordinate) in position.as_array_mut().iter_mut().enumerate() {
        *coordinate = moved(place[axis], T::finish(sums[axis]))?;
    }
    Ok(position)
}

/// A coordinate moved by a step, of which neither may be at the end of fixed point's range.
fn moved<T: Scalar>(coordinate: T, step: T) -> Result<T, Error> {
    let moved = coordinate + step;
    if step.is_finite() && moved.is_finite() { Ok(moved) } else { Err(Error::NotFinite) }
}

/// Half of d₀² − dᵢ² + |aᵢ − a₀|², relative to a₀ and without the contribution of the known height. Not finite where it leaves the
/// range of fixed point, which its terms may do.
#[inline(always)]
fn right_side<T: Scalar, const D: usize>(
    (first, first_range): (&SVector<T, 3>, T),
    (anchor, range): (&SVector<T, 3>, T),
    height: T,
) -> T {
    let mean = first_range * T::HALF + range * T::HALF;
    let mut sum = T::mac(T::accumulator(), first_range - range, mean);
    for axis in 0..3 {
        let apart = anchor.as_array()[axis] - first.as_array()[axis];
        sum = T::mac(sum, apart, apart * T::HALF);
        if axis >= D {
            sum = T::mac(sum, apart, first.as_array()[axis] - height);
        }
    }
    T::finish(sum)
}

/// aᵢ − a₀, half of the paper's row: the factor of two is moved to the right side.
fn row<T: Scalar, const D: usize>(anchor: &SVector<T, 3>, first: &SVector<T, 3>) -> [T; D] {
    core::array::from_fn(|axis| anchor.as_array()[axis] - first.as_array()[axis])
}
