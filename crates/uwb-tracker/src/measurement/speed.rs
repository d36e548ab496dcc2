use super::CONTRADICTION;
use kestirim_kalman::{Error, Gaussian, Observation, SparseRow};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// Speed of the wheels: the magnitude of the velocity, measured along its direction.
///
/// Physics: h(x) = |v|. A robot on wheels drives straight; forwards and backwards are equivalent.
///
/// Jacobian: ∂h/∂v = v/|v|, zero otherwise. While the driving direction of the robot is unknown, there is none.
///
/// Source: wheel odometry (Siegwart, Nourbakhsh and Scaramuzza 2011, 5.2.4), without the turn.
pub(crate) struct Speed<T, const D: usize> {
    /// The mean speed of the wheels, m/s.
    pub(crate) measured: T,
}

impl<T: Scalar, const D: usize> Speed<T, D> {
    /// Standard deviation of the speed, m/s: the wheels slip, and the tag is not midway between them.
    const SIGMA: f64 = 0.1;
    /// Smallest velocity whose direction is meaningful, m/s.
    const LEAST: f64 = 0.02;

    /// Updates the estimate, unless its velocity has no direction yet or contradicts the measurement.
    #[inline]
    pub(crate) fn correct<const N: usize>(
        &self,
        estimate: &mut Gaussian<T, N>,
    ) -> Result<(), Error> {
        let variance = T::from_f64(Self::SIGMA * Self::SIGMA);
        let weighed = match estimate.weigh_observation(self, variance) {
            Err(Error::NotLinearisable) => return Ok(()),
            weighed => weighed?,
        };
        if !weighed.exceeds(T::from_f64(CONTRADICTION)) {
            estimate.correct(&weighed)?;
        }
        Ok(())
    }
}

impl<T: Scalar, const D: usize, const N: usize> Observation<T, N> for Speed<T, D> {
    type Row = SparseRow<T, D>;

    #[inline]
    fn linearise(&self, mean: &SVector<T, N>) -> Result<(T, Self::Row), Error> {
        let velocity: [T; D] =
            core::array::from_fn(|axis| mean.as_array().get(D + axis).copied().unwrap_or(T::ZERO));
        let (size, measured) = (T::norm(&velocity), self.measured.abs());
        // The direction must be known before the speed helps.
        if size < measured * T::HALF || size <= T::from_f64(Self::LEAST) {
            return Err(Error::NotLinearisable);
        }
        let divisor = size.divisor();
        let row = core::array::from_fn(|axis| (D + axis, velocity[axis].divided_by(divisor)));
        Ok((measured - size, SparseRow::new(row)))
    }
}
