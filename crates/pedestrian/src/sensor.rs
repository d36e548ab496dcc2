use kestirim_scalar::Scalar;

/// The class of an IMU: what may be expected of it before it has said anything.
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

/// Noise densities and priors of a class, in SI units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise<T> {
    /// Standard deviation of the gyro bias at power-on (rad/s).
    pub(crate) gyro_bias: T,
    /// Standard deviation of the accelerometer's magnitude at rest, relative to g.
    pub(crate) gravity: T,
    /// Velocity random walk, with scale and mounting errors in a swing absorbed (m/s²/√Hz).
    pub(crate) specific_force: T,
    /// Angle random walk, with the same absorbed (rad/s/√Hz).
    pub(crate) angular_rate: T,
}

impl SensorClass {
    pub(crate) fn noise<T: Scalar>(self) -> Noise<T> {
        let (gyro_bias, gravity, angular_rate) = match self {
            Self::Industrial => (0.003, 0.01, 0.01),
            Self::Consumer => (0.1, 0.05, 0.03),
        };
        Noise {
            gyro_bias: T::from_f64(gyro_bias),
            gravity: T::from_f64(gravity),
            specific_force: T::from_f64(0.3),
            angular_rate: T::from_f64(angular_rate),
        }
    }
}
