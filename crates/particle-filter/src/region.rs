use kestirim_scalar::Scalar;

use crate::Error;

/// A box with its sides along the axes: the support of a prior.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "Bounds<T, D>",
        bound(
            serialize = "T: serde::Serialize",
            deserialize = "T: Scalar + serde::Deserialize<'de>"
        )
    )
)]
pub struct Region<T, const D: usize> {
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    low: [T; D],
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    high: [T; D],
}

/// A region as stored, whose bounds are yet to be checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(bound(deserialize = "T: Scalar + serde::Deserialize<'de>"))]
struct Bounds<T, const D: usize> {
    #[serde(with = "kestirim_snapshot::arrays")]
    low: [T; D],
    #[serde(with = "kestirim_snapshot::arrays")]
    high: [T; D],
}

#[cfg(feature = "serde")]
impl<T: Scalar, const D: usize> TryFrom<Bounds<T, D>> for Region<T, D> {
    type Error = Error;

    fn try_from(bounds: Bounds<T, D>) -> Result<Self, Error> {
        Self::new(bounds.low, bounds.high)
    }
}

impl<T: Scalar, const D: usize> Region<T, D> {
    /// The box between two corners; `low` has the smaller coordinates.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if a corner or a width is not finite; [`Error::NotPositive`] if a coordinate of `low` is
    /// above that of `high`.
    #[inline]
    pub fn new(low: [T; D], high: [T; D]) -> Result<Self, Error> {
        for axis in 0..D {
            let width = high[axis] - low[axis];
            if !T::all_finite(&[low[axis], high[axis], width]) {
                return Err(Error::NotFinite);
            }
            if width < T::ZERO {
                return Err(Error::NotPositive);
            }
        }
        Ok(Self { low, high })
    }

    /// The same box with additional coordinates, in which both corners are zero.
    #[inline]
    pub fn extended<const K: usize>(&self) -> Region<T, K> {
        const { assert!(K >= D, "coordinates are added") };
        let mut region = Region { low: [T::ZERO; K], high: [T::ZERO; K] };
        for axis in 0..D {
            region.low[axis] = self.low[axis];
            region.high[axis] = self.high[axis];
        }
        region
    }

    /// The corner with the smallest coordinates.
    #[inline(always)]
    pub fn low(&self) -> &[T; D] {
        &self.low
    }

    /// The corner with the largest coordinates.
    #[inline(always)]
    pub fn high(&self) -> &[T; D] {
        &self.high
    }

    /// The lengths of the sides.
    #[inline(always)]
    pub fn width(&self) -> [T; D] {
        let mut width = [T::ZERO; D];
        for axis in 0..D {
            width[axis] = self.high[axis] - self.low[axis];
        }
        width
    }

    /// Whether a point is inside, borders included.
    #[inline(always)]
    pub fn contains(&self, point: &[T; D]) -> bool {
        let mut inside = true;
        for axis in 0..D {
            inside &= self.low[axis] <= point[axis] && point[axis] <= self.high[axis];
        }
        inside
    }
}
