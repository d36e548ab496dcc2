use crate::Error;
use kestirim_scalar::{Components, Scalar};
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
    /// The time of the sample (µs since an arbitrary moment), an integer because a float's seconds grow coarse within
    /// an hour.
    pub time_us: u64,
    /// The specific force, as measured by an accelerometer (m/s², body): +g upwards at rest.
    pub specific_force: SVector<T, 3>,
    /// The angular rate, as measured by a gyroscope (rad/s, body).
    pub angular_rate: SVector<T, 3>,
}

impl<T: Scalar> ImuSample<T> {
    /// The largest specific force, 1000 g (m/s²).
    const MAX_FORCE: f64 = 9806.65;
    /// The largest angular rate, 10⁵ °/s (rad/s).
    const MAX_RATE: f64 = 1745.33;
    /// A specific force a little below the smallest range of an accelerometer, 2 g (m/s²).
    pub(crate) const LARGE_FORCE: f64 = 18.0;
    /// An angular rate a little below the smallest range of a gyroscope, 250 °/s (rad/s).
    pub(crate) const LARGE_RATE: f64 = 4.2;

    /// Refuses a sample that no sensor can have measured.
    #[inline]
    pub(crate) fn check(&self) -> Result<Size, Error> {
        Ok(Size {
            large_force: is_large(&self.specific_force, Self::LARGE_FORCE, Self::MAX_FORCE)?,
            large_rate: is_large(&self.angular_rate, Self::LARGE_RATE, Self::MAX_RATE)?,
        })
    }
}

/// Flags of a sample's vectors that are so large that a sensor's range may end there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size {
    pub(crate) large_force: bool,
    pub(crate) large_rate: bool,
}

/// Whether a component is at least `large`; most are not, and then no further check is needed.
#[inline]
fn is_large<T: Scalar>(vector: &SVector<T, 3>, large: f64, max: f64) -> Result<bool, Error> {
    if within(vector, T::from_f64(large)) {
        Ok(false)
    } else if within(vector, T::from_f64(max)) {
        Ok(true)
    } else {
        Err(refusal(vector))
    }
}

/// Why a vector cannot have been measured.
#[cold]
#[inline(never)]
fn refusal<T: Scalar>(vector: &SVector<T, 3>) -> Error {
    let finite = vector.as_array().iter().all(|component| component.is_finite());
    if finite { Error::Implausible } else { Error::NotFinite }
}

/// Whether every component is a number of at most this size; a NaN is not.
#[inline]
fn within<T: Scalar>(vector: &SVector<T, 3>, limit: T) -> bool {
    vector.as_array().iter().all(|component| component.abs() < limit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_axis_is_within_what_a_sensor_measures() {
        let check = |force: SVector<f64, 3>, rate: SVector<f64, 3>| {
            ImuSample { time_us: 0, specific_force: force, angular_rate: rate }.check()
        };
        let size = |large_force, large_rate| Ok(Size { large_force, large_rate });
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                let on = |value: f64| {
                    SVector::from_fn(|other, _| if other == axis { value * sign } else { 0.1 })
                };
                let calm = on(1.0);
                assert_eq!(check(on(17.9), on(4.1)), size(false, false));
                assert_eq!(check(on(18.0), on(4.1)), size(true, false));
                assert_eq!(check(on(17.9), on(4.2)), size(false, true));
                assert_eq!(check(on(9806.0), on(1745.0)), size(true, true));
                assert_eq!(check(on(9807.0), calm), Err(Error::Implausible));
                assert_eq!(check(calm, on(1746.0)), Err(Error::Implausible));
                assert_eq!(check(on(f64::INFINITY), calm), Err(Error::NotFinite));
                assert_eq!(check(calm, on(f64::NAN)), Err(Error::NotFinite));
            }
        }
    }
}
