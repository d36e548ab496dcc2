//! What the drone measures, by the thesis' channel.

use kestirim_air_to_ground::{Channel, Environment};
use kestirim_scalar::Scalar;
use rand_core::Rng;

use crate::metrics::distance;
use crate::random::{normal, uniform};

/// Wavelength of 2 GHz with the thesis' speed of light, m.
pub const WAVELENGTH_M: f64 = 0.15;

/// What is built on the ground.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::ValueEnum)]
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
    pub fn channel<T: Scalar>(self) -> Channel<T> {
        let environment = match self {
            Self::Suburban => Environment::suburban(),
            Self::Urban => Environment::urban(),
            Self::DenseUrban => Environment::dense_urban(),
            Self::HighRise => Environment::high_rise(),
        };
        Channel::new(&environment, T::from_f64(WAVELENGTH_M)).expect("the thesis' constants")
    }
}

/// A loss that the drone measures above `place` at `height_m`, dB: with or without a line of sight by
/// chance.
pub fn measure<R: Rng + ?Sized>(
    channel: &Channel<f64>,
    user: [f64; 2],
    place: [f64; 2],
    height_m: f64,
    rng: &mut R,
) -> f64 {
    let expected =
        channel.path_loss(distance(user, place), height_m).expect("a place and a height");
    let (mean, sigma) = if uniform(rng) < expected.line_of_sight_probability {
        (expected.line_of_sight_mean, expected.line_of_sight_sigma)
    } else {
        (expected.obstructed_mean, expected.obstructed_sigma)
    };
    mean + normal(rng, sigma)
}
