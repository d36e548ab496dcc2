use crate::Error;
use kestirim_scalar::Scalar;
use nalgebra::SVector;

/// One sample of the foot's IMU, in body axes (right-handed).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct ImuSample<T: Scalar> {
    /// When it was taken (µs since any moment). Integers, because a float's seconds grow coarse in an hour.
    pub time_us: u64,
    /// What the accelerometer measures (m/s²): +g upwards at rest.
    pub specific_force: SVector<T, 3>,
    /// What the gyroscope measures (rad/s).
    pub angular_rate: SVector<T, 3>,
}

impl<T: Scalar> ImuSample<T> {
    /// 1000 g, in m/s².
    const MAX_FORCE: f64 = 9806.65;
    /// 10⁵ °/s, in rad/s.
    const MAX_RATE: f64 = 1745.33;

    /// Refuses what no sensor can have measured.
    #[inline]
    pub(crate) fn check(&self) -> Result<(), Error> {
        let force = within(&self.specific_force, T::from_f64(Self::MAX_FORCE));
        let rate = within(&self.angular_rate, T::from_f64(Self::MAX_RATE));
        if force && rate {
            return Ok(());
        }
        let mut components = self.specific_force.iter().chain(self.angular_rate.iter());
        Err(if components.all(|c| c.is_finite()) { Error::Implausible } else { Error::NotFinite })
    }
}

/// Whether every component is a number of at most this size; a NaN is not.
#[inline]
fn within<T: Scalar>(vector: &SVector<T, 3>, limit: T) -> bool {
    vector.data.0[0].iter().all(|component| component.abs() < limit)
}
