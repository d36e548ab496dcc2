use crate::Error;
use crate::symmetric::{MOST, NormalEquations};
use kestirim_scalar::Scalar;
use nalgebra::SVector;

/// Linear trilateration (the paper's eqs 3–7): the first anchor's sphere subtracted from the others', and
/// the pseudo-inverse, which depends on the anchors alone, computed once.
///
/// With D = 2 the tag is at a known height. Noise of the first anchor enters every equation, and there is
/// no weighting: [`Solver`](crate::Solver) is better by a tenth to a third; this is faster, and a start.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Trilateration<T: Scalar, const A: usize, const D: usize> {
    anchors: [SVector<T, 3>; A],
    /// (MᵀM)⁻¹Mᵀ for the rows 2(aᵢ − a₀); the column of the first anchor is zero.
    pseudo_inverse: [[T; A]; D],
}

impl<T: Scalar, const A: usize, const D: usize> Trilateration<T, A, D> {
    /// Prepares for anchors at these places (room axes, m).
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::TooFewRanges`] for fewer than D + 1 anchors, or
    /// [`Error::DegenerateGeometry`] if they stand in a line (D = 2) or a plane (D = 3).
    pub fn new(anchors: [SVector<T, 3>; A]) -> Result<Self, Error> {
        const { assert!(0 < D && D <= 3, "a position has up to three coordinates") };
        if A <= D {
            return Err(Error::TooFewRanges);
        }
        if !anchors.iter().flat_map(|anchor| anchor.iter()).all(|entry| entry.is_finite()) {
            return Err(Error::NotFinite);
        }
        let mut equations = NormalEquations::new(D);
        for anchor in &anchors {
            equations.add(&row::<T, D>(anchor, &anchors), T::ZERO, T::ONE);
        }
        let factors = equations.factorised(T::from_f64(1e-4)).ok_or(Error::DegenerateGeometry)?;
        let mut pseudo_inverse = [[T::ZERO; A]; D];
        for (index, anchor) in anchors.iter().enumerate() {
            let column = factors.solve(&row::<T, D>(anchor, &anchors));
            for (line, entry) in pseudo_inverse.iter_mut().zip(column) {
                line[index] = entry;
            }
        }
        Ok(Self { anchors, pseudo_inverse })
    }

    /// Where the tag is whose ranges (m) are these; `height` (m) is not read in three dimensions.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn position(&self, ranges: &[T; A], height: T) -> Result<SVector<T, D>, Error> {
        let mut position = self.anchors.first().map_or(SVector::zeros(), |first| {
            SVector::<T, D>::from_fn(|axis, _| first.data.0[0][axis])
        });
        let (Some(&first), Some(first_range)) = (self.anchors.first(), ranges.first()) else {
            return Err(Error::TooFewRanges);
        };
        let mut right = [T::ZERO; A];
        for ((right, anchor), &range) in right.iter_mut().zip(&self.anchors).zip(ranges) {
            // d₀² − dᵢ² + |aᵢ − a₀|² relative to a₀, products of differences: squares of tens of
            // metres would leave the range of fixed point.
            let mut sum = (*first_range - range) * (*first_range + range);
            for axis in 0..3 {
                let apart = anchor.data.0[0][axis] - first.data.0[0][axis];
                sum += apart * apart;
                if axis >= D {
                    let tag = height - first.data.0[0][axis];
                    sum -= T::TWO * apart * tag;
                }
            }
            *right = sum * T::HALF;
        }
        for (coordinate, line) in position.iter_mut().zip(&self.pseudo_inverse) {
            *coordinate += T::dot(line, &right);
        }
        let finite = position.iter().all(|coordinate| coordinate.is_finite());
        if finite { Ok(position) } else { Err(Error::NotFinite) }
    }
}

/// aᵢ − a₀, half of the paper's row: the other half stands on the right.
fn row<T: Scalar, const D: usize>(anchor: &SVector<T, 3>, anchors: &[SVector<T, 3>]) -> [T; MOST] {
    let mut row = [T::ZERO; MOST];
    if let Some(first) = anchors.first() {
        for axis in 0..D {
            row[axis] = anchor.data.0[0][axis] - first.data.0[0][axis];
        }
    }
    row
}
