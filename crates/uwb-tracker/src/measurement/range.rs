use kestirim_kalman::{Error, Observation};
use kestirim_scalar::{Components, Scalar};
use kestirim_uwb_ranging::{ExpectedRange, expected_range};
use nalgebra::SVector;

/// A range to an anchor: the slant distance plus the bias common to all ranges.
///
/// Physics: h(x) = |p − a| + (c + s |p − a|) b, with the tag's position p, the anchor's position a and the common bias
/// b. In an office c is 1 and s is 0; among anchors far apart the excess of ranges grows with the distance, and b is
/// that of a range whose length is the distance from the anchors' centre to them.
///
/// Jacobian: ∂h/∂p = (p − a)/|p − a|, ∂h/∂b = c + s |p − a|, zero otherwise: the neglected s b is a few hundredths of
/// ∂h/∂p. Where too few anchors are heard to distinguish b from a distance, ∂h/∂b is taken as zero: b then changes
/// only through its covariance with the position.
///
/// Source: the paper's eq. 10; the common bias as the clock bias of a GNSS receiver's pseudorange (Kaplan and
/// Hegarty 2017, 2.5.2).
pub(crate) struct Range<'a, T: Scalar, const D: usize> {
    /// The measured distance without the anchor's own bias, m.
    pub(crate) measured: T,
    /// The anchor's position in the room frame, m.
    pub(crate) anchor: &'a SVector<T, 3>,
    /// The tag's height, m, for a position in two dimensions.
    pub(crate) height: T,
    /// Whether enough anchors are heard to distinguish a common bias from a distance.
    pub(crate) observes_bias: bool,
    /// The constants c and s.
    pub(crate) bias_shape: [T; 2],
}

/// ∂h/∂x of a [`Range`]: D direction components, and the common bias where it is a state.
pub(crate) struct RangeRow<T, const D: usize, const N: usize>([(usize, T); 4]);

impl<T, const D: usize, const N: usize> AsRef<[(usize, T)]> for RangeRow<T, D, N> {
    #[inline(always)]
    fn as_ref(&self) -> &[(usize, T)] {
        self.0.get(..N - D).unwrap_or(&self.0)
    }
}

impl<T: Scalar, const D: usize, const N: usize> Observation<T, N> for Range<'_, T, D> {
    type Row = RangeRow<T, D, N>;

    #[inline(always)]
    fn linearise(&self, mean: &SVector<T, N>) -> Result<(T, Self::Row), Error> {
        let mean = mean.as_array();
        let position = SVector::<T, D>::from_fn(|axis, _| mean[axis]);
        let ExpectedRange { distance, direction } =
            expected_range(&position, self.height, self.anchor);
        let mut row = [(0, T::ZERO); 4];
        for axis in 0..D {
            row[axis] = (axis, direction[axis]);
        }
        if N == 2 * D {
            return Ok((self.measured - distance, RangeRow(row)));
        }
        let [constant, slope] = self.bias_shape;
        let excess = constant + slope * distance;
        row[D] = (2 * D, if self.observes_bias { excess } else { T::ZERO });
        Ok((self.measured - distance - excess * mean[2 * D], RangeRow(row)))
    }
}
