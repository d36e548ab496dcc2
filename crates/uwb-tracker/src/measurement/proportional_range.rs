use crate::wheels::state;
use kestirim_kalman::{Error, Observation, SparseRow};
use kestirim_scalar::{Components, Scalar};
use kestirim_uwb_ranging::{ExpectedRange, expected_range};
use nalgebra::SVector;

/// A range to an anchor with an excess proportional to the distance, for a robot on wheels.
///
/// Physics: h(x) = |p − a| (1 + e/10 m) + b, with the tag's position p, the anchor's position a, the excess e of a
/// range of 10 m, and the common bias b. Radio clocks and thresholds, and the receive level, make ranges too long in
/// proportion to the distance: by 7 % for one of the recorded radios.
///
/// Jacobian: ∂h/∂p = (1 + e/10 m) (p − a)/|p − a|, ∂h/∂b = 1, ∂h/∂e = |p − a|/10 m, zero otherwise.
///
/// Source: the scale of measured ranges in Djugash and Singh, *A robust method of localization and mapping using only
/// range* (2008), in addition to the common bias of [`super::Range`].
pub(crate) struct ProportionalRange<'a, T: Scalar> {
    /// The measured distance without the anchor's own bias, m.
    pub(crate) measured: T,
    /// The anchor's position in the room frame, m.
    pub(crate) anchor: &'a SVector<T, 3>,
    /// The tag's height, m.
    pub(crate) height: T,
}

impl<T: Scalar> Observation<T, { state::COUNT }> for ProportionalRange<'_, T> {
    type Row = SparseRow<T, 4>;

    #[inline(always)]
    fn linearise(&self, mean: &SVector<T, { state::COUNT }>) -> Result<(T, Self::Row), Error> {
        let mean = mean.as_array();
        let position = SVector::<T, 2>::new(mean[state::X], mean[state::Y]);
        let ExpectedRange { distance, direction } =
            expected_range(&position, self.height, self.anchor);
        let tens = distance * T::from_f64(0.1);
        let gain = T::ONE + mean[state::EXCESS] * T::from_f64(0.1);
        let innovation = self.measured - distance - tens * mean[state::EXCESS] - mean[state::BIAS];
        let row = [
            (state::X, gain * direction[0]),
            (state::Y, gain * direction[1]),
            (state::BIAS, T::ONE),
            (state::EXCESS, tens),
        ];
        Ok((innovation, SparseRow::new(row)))
    }
}
