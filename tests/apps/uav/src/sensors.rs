//! The sensors: their setup, and their measurements in SI units.

use bno055::{BNO055OperationMode, Bno055};
use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use ms4525do::{Ms4525do, Ms4525doError, calculate_airspeed};

/// Why a reading failed; `B` is the error of the inertial sensor's bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SensorError<B> {
    /// The inertial sensor's bus failed.
    Bus(B),
    /// Another chip answered in place of the inertial sensor, with this identity.
    WrongChip(u8),
    /// The inertial sensor's driver gave up.
    Driver,
    /// The airspeed sensor could not be read, or reports a fault.
    Airspeed(Ms4525doError),
}

impl<B> From<bno055::Error<B>> for SensorError<B> {
    fn from(error: bno055::Error<B>) -> Self {
        match error {
            bno055::Error::I2c(error) => Self::Bus(error),
            bno055::Error::InvalidChipId(identity) => Self::WrongChip(identity),
            _ => Self::Driver,
        }
    }
}

/// A BNO055 whose y axis is the aeroplane's, and an MS4525DO (1 psi) at the Pitot tube.
pub struct Sensors<I, A, D> {
    inertial: Bno055<I>,
    airspeed: Ms4525do<A>,
    delay: D,
}

impl<I: I2c, A: I2c, D: DelayNs> Sensors<I, A, D> {
    /// Sets up the inertial sensor; the airspeed sensor needs no setup.
    ///
    /// # Errors
    /// [`SensorError`].
    pub fn new(inertial: I, airspeed: A, mut delay: D) -> Result<Self, SensorError<I::Error>> {
        let mut inertial = Bno055::new(inertial);
        inertial.init(&mut delay)?;
        inertial.set_mode(BNO055OperationMode::NDOF, &mut delay)?;
        Ok(Self { inertial, airspeed: Ms4525do::new(airspeed), delay })
    }

    /// Pitch rate (rad/s), airspeed (m/s) and pitch (rad): the outputs of [`crate::aeroplane`].
    ///
    /// # Errors
    /// [`SensorError`].
    pub fn read(&mut self) -> Result<[f32; 3], SensorError<I::Error>> {
        let rate = self.inertial.gyro_data()?.y;
        let pitch = self.inertial.euler_angles()?.b;
        let (pressure, temperature) =
            self.airspeed.read_data(&mut self.delay).map_err(SensorError::Airspeed)?;
        Ok([rate.to_radians(), calculate_airspeed(pressure, temperature), pitch.to_radians()])
    }
}
