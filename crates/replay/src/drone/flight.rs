//! What a drone measures, and where.

use kestirim_air_to_ground::{Channel, Environment, Error as ChannelError, Measurement};
use kestirim_scalar::Scalar;
use kestirim_user_locator::LevelStep;

/// Most corners of an area.
pub const MOST_CORNERS: usize = 4096;

/// Where the user can be: a polygon, m.
pub type Area = kestirim_user_locator::Area<f64, MOST_CORNERS>;

/// What was measured.
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
    /// s.
    pub t: f64,
    /// Where the drone was, m.
    pub place: [f64; 2],
    /// Its height above the user, m.
    pub height: f64,
    /// The path loss, or the negative level, dB.
    pub loss: f64,
    /// Where its nose pointed, if that is known: rad, clockwise from the second axis of the plane (north) to the first (east).
    pub heading: Option<f64>,
}

/// Heights above which no drone flies, m.
const HIGHEST_M: f64 = 20_000.0;
/// No radio measures a larger loss or level, dB.
const LARGEST_DB: f64 = 300.0;

impl Stop {
    /// Whether a channel can use it.
    pub fn is_usable(&self) -> bool {
        self.height > 0.0 && self.height < HIGHEST_M && self.loss.abs() <= LARGEST_DB
    }
}

/// Wavelength of 2 GHz with the thesis' speed of light, m.
pub const WAVELENGTH_M: f64 = 0.15;

/// The speed of light as the thesis has it, m/s.
const LIGHT: f64 = 3e8;

/// Wavelength of a frequency (Hz), m.
pub fn wavelength_m(frequency_hz: f64) -> f64 {
    LIGHT / frequency_hz
}

/// What is built on the ground.
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
    /// Its channel at 2 GHz.
    ///
    /// # Panics
    /// Never: the published constants make a channel.
    pub fn channel<T: Scalar>(self) -> Channel<T> {
        self.channel_at(WAVELENGTH_M).expect("the thesis' constants")
    }

    /// Its channel at a wavelength (m). What is lost beyond free space is what was published for 2 GHz.
    ///
    /// # Errors
    /// [`ChannelError`] if it is no wavelength.
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

/// When the levels step, s, and by how much, dB, as seen from the estimated place.
pub fn level_step(stops: &[Stop], place: [f64; 2]) -> Option<(f64, f64)> {
    let measured = |stop: &Stop| {
        let measurement = Measurement::new(stop.place, stop.height, stop.loss).ok()?;
        Some((stop.t, measurement))
    };
    let (times, measurements): (Vec<_>, Vec<_>) = stops.iter().filter_map(measured).unzip();
    let LevelStep { at, by } = LevelStep::find(&measurements, place)?;
    Some((times[at], by))
}
