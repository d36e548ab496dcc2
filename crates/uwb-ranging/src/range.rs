use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// The expected range to an anchor at a known position, and its derivatives with respect to the tag's position.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ExpectedRange<T, const D: usize> {
    /// Slant distance from anchor to tag, m (the paper's eq. 10).
    pub distance: T,
    /// ∂distance/∂position: the first D components of the unit vector from anchor to tag; zero if the two coincide.
    pub direction: [T; D],
}

/// The distance from an anchor to a tag and its derivatives, in the room frame (right-handed, z up; m).
///
/// With D = 2 the tag's height is known: every coordinate from D on equals `height`. With D = 3, `height` is not
/// used.
#[inline]
pub fn expected_range<T: Scalar, const D: usize>(
    position: &SVector<T, D>,
    height: T,
    anchor: &SVector<T, 3>,
) -> ExpectedRange<T, D> {
    const { assert!(0 < D && D <= 3, "a position has up to three coordinates") };
    let mut offset = [T::ZERO; 3];
    for axis in 0..3 {
        let tag = if axis < D { position.as_array()[axis] } else { height };
        offset[axis] = tag - anchor.as_array()[axis];
    }
    let distance = T::norm(&offset);
    // Where the distance is zero, so is the offset.
    let divisor = distance.max(T::EPSILON).divisor();
    let mut direction = [T::ZERO; D];
    for axis in 0..D {
        direction[axis] = offset[axis].divided_by(divisor);
    }
    ExpectedRange { distance, direction }
}
