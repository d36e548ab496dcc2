use kestirim_scalar::Scalar;

/// The class of an IMU: the prior of its biases and its noise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SensorClass {
    /// Calibrated units (`MicroStrain`, Xsens, NGIMU): the gyroscope starts within 3 mrad/s of zero.
    Industrial,
    /// Bare chips (MPU-6050, MPU-9250, the Razor): the gyroscope may start 0.1 rad/s off.
    #[default]
    Consumer,
}

/// The prior standard deviations of a class.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prior {
    /// The standard deviation of the gyro bias at power-on (rad/s).
    pub(crate) gyro_bias: f64,
    /// The standard deviation of the accelerometer's magnitude at rest, relative to g.
    pub(crate) gravity: f64,
}

/// The process noise of an error-state filter.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Noise<T> {
    /// Velocity random walk, with scale and mounting errors in a swing absorbed: 0.3 m/s²/√Hz squared, scaled.
    pub(crate) velocity_variance: T,
    /// Angle random walk, with scale and mounting errors in a swing absorbed: 0.005 or 0.02 rad/s/√Hz squared, scaled.
    pub(crate) attitude_variance: T,
}

impl SensorClass {
    pub(crate) fn prior(self) -> Prior {
        match self {
            Self::Industrial => Prior { gyro_bias: 0.003, gravity: 0.01 },
            Self::Consumer => Prior { gyro_bias: 0.1, gravity: 0.05 },
        }
    }

    /// The largest residual velocity of a healthy sensor at the end of a swing, horizontal and vertical, averaged over
    /// eight strides (m/s).
    ///
    /// Of 30 walks with intact gyroscopes none left more than 0.57 and 0.09 (industrial), 0.40 and 0.17 (consumer); a
    /// scale that is 5 % wrong leaves 0.16 to 0.22 upwards, a zero that is 3 °/s wrong 1.0 to 1.8 sideways.
    #[inline] // So that the constants fold: without that, double precision is linked.
    pub(crate) fn landing<T: Scalar>(self) -> [T; 2] {
        match self {
            Self::Industrial => [T::from_f64(0.75), T::from_f64(0.12)],
            Self::Consumer => [T::from_f64(0.5), T::from_f64(0.2)],
        }
    }

    /// The standard deviation of the constant rate at which the heading of a walk drifts (rad/s).
    #[inline] // So that the constants fold.
    pub fn heading_rate<T: Scalar>(self) -> T {
        match self {
            Self::Industrial => T::from_f64(0.00048),
            Self::Consumer => T::from_f64(0.002),
        }
    }

    /// The standard deviation of the common scale of all strides of a walk.
    #[inline] // So that the constants fold.
    pub fn stride_scale<T: Scalar>(self) -> T {
        match self {
            Self::Industrial => T::from_f64(0.005),
            Self::Consumer => T::from_f64(0.01),
        }
    }

    /// Whether the heading of such a sensor may drift at this rate (rad/s), within four standard deviations.
    ///
    /// A faster turn where a foot stood twice is due to the field, because iron came near, or to the magnetometer,
    /// which then shows nothing about the heading.
    #[inline] // So that the constants fold.
    pub fn drifts_by<T: Scalar>(self, rate: T) -> bool {
        rate.abs() < self.heading_rate::<T>() * T::from_f64(4.0)
    }

    /// The standard deviation of the height error that is common to all strides of a walk (m): that of 24 and 7
    /// recorded walks on level ground.
    #[inline] // So that the constants fold.
    pub fn height_drift<T: Scalar>(self) -> T {
        match self {
            Self::Industrial => T::from_f64(0.012),
            Self::Consumer => T::from_f64(0.04),
        }
    }

    /// Variances per second, multiplied by `scale`.
    pub(crate) fn noise<T: Scalar>(self, scale: f64) -> Noise<T> {
        let attitude = match self {
            Self::Industrial => 0.005,
            Self::Consumer => 0.02,
        };
        Noise {
            velocity_variance: T::from_f64(0.3 * 0.3 * scale),
            attitude_variance: T::from_f64(attitude * attitude * scale),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_gyroscope_drifts_by_is_the_field() {
        let [calibrated, bare] = [SensorClass::Industrial, SensorClass::Consumer];
        assert!(calibrated.drifts_by(0.0015) && calibrated.drifts_by(-0.0015));
        assert!(!calibrated.drifts_by(0.0025) && bare.drifts_by(0.0025));
        assert!(!bare.drifts_by(f64::NAN));
    }
}
