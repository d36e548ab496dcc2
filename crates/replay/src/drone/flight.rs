//! The measurements of a drone, and their places.

use kestirim_air_to_ground::{Channel, Environment, Error as ChannelError, Measurement};
use kestirim_scalar::Scalar;
use kestirim_user_locator::LevelStep;

/// The largest number of corners of an area.
pub const MOST_CORNERS: usize = 4096;

/// The area in which the user can be: a polygon, m.
pub type Area = kestirim_user_locator::Area<f64, MOST_CORNERS>;

/// The measured quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Path loss, dB.
    PathLoss,
    /// Received level of unknown offset, dB.
    Level,
}

/// One measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// Time, s.
    pub t: f64,
    /// The place of the drone, m.
    pub place: [f64; 2],
    /// The height of the drone above the user, m.
    pub height: f64,
    /// The path loss, or the negative level, dB.
    pub loss: f64,
    /// The heading of the drone, if known: rad, clockwise from the second axis of the plane (north) to the first
    /// (east).
    pub heading: Option<f64>,
}

/// The height above which no drone flies, m.
const HIGHEST_M: f64 = 20_000.0;
/// The largest loss or level that a radio measures, dB.
const LARGEST_DB: f64 = 300.0;

impl Stop {
    /// Whether a channel can use it.
    pub fn is_usable(&self) -> bool {
        self.height > 0.0 && self.height < HIGHEST_M && self.loss.abs() <= LARGEST_DB
    }
}

/// The wavelength of 2 GHz with the thesis' speed of light, m.
pub const WAVELENGTH_M: f64 = 0.15;

/// The speed of light in the thesis, m/s.
const LIGHT: f64 = 3e8;

/// The wavelength (m) of a frequency (Hz).
pub fn wavelength_m(frequency_hz: f64) -> f64 {
    LIGHT / frequency_hz
}

/// The kind of environment on the ground.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum EnvironmentKind {
    /// Suburbs and villages
    Suburban,
    /// A European city
    #[default]
    Urban,
    /// A city whose houses stand close together
    DenseUrban,
    /// A city of skyscrapers
    HighRise,
}

impl EnvironmentKind {
    /// The channel of the environment at 2 GHz.
    ///
    /// # Panics
    /// Never: the published constants make a channel.
    pub fn channel<T: Scalar>(self) -> Channel<T> {
        self.channel_at(WAVELENGTH_M).expect("the thesis' constants")
    }

    /// The channel of the environment at a wavelength (m). The loss beyond free space is the one published for 2 GHz.
    ///
    /// # Errors
    /// [`ChannelError`] if the wavelength is invalid.
    pub fn channel_at<T: Scalar>(self, wavelength_m: f64) -> Result<Channel<T>, ChannelError> {
        let environment = match self {
            Self::Suburban => Environment::suburban(),
            Self::Urban => Environment::urban(),
            Self::DenseUrban => Environment::dense_urban(),
            Self::HighRise => Environment::high_rise(),
        };
        Channel::new(&environment, T::from_f64(wavelength_m))
    }
}

/// The time (s) and the size (dB) of a step in the levels, as seen from the estimated place.
pub fn level_step(stops: &[Stop], place: [f64; 2]) -> Option<(f64, f64)> {
    let measured = |stop: &Stop| {
        let measurement = Measurement::new(stop.place, stop.height, stop.loss).ok()?;
        Some((stop.t, measurement))
    };
    let (times, measurements): (Vec<_>, Vec<_>) = stops.iter().filter_map(measured).unzip();
    let LevelStep { at, by } = LevelStep::find(&measurements, place)?;
    Some((times[at], by))
}
