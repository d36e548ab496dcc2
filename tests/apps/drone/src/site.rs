//! Where the search is, and for what: what is to be changed first when this is copied.

use kestirim_air_to_ground::{Channel, Environment};
use kestirim_particle_filter::Region;
use kestirim_user_locator::Motion;

use crate::Error;

/// Latitude and longitude of the origin, degrees; x is east of it, y north.
pub const ORIGIN: [f64; 2] = [39.925_0, 32.836_9];
/// How high the users' ground is above the sea, m.
pub const GROUND: f32 = 890.0;
/// The side of the square that the user is in, from the origin eastwards and northwards, m.
pub const SIDE: f32 = 2_000.0;

/// The user's radio: 868 MHz, m.
pub const WAVELENGTH: f32 = 0.345;
/// What the user's radio radiates, and what both antennas add, dBm.
pub const LEVEL: f32 = 22.0;
/// The user's address.
pub const USER: u16 = 50;

/// A drone measures no better than this, dB: the module tells whole ones.
const LEAST_SIGMA: f32 = 1.0;
/// How old a place may be when a level comes, µs.
pub(crate) const FRESH_US: u64 = 1_500_000;

/// Between radios in the air and on the ground of a city.
///
/// # Errors
/// None with these numbers.
pub fn channel() -> Result<Channel<f32>, Error> {
    let channel = Channel::new(&Environment::urban(), WAVELENGTH);
    channel.and_then(|channel| channel.with_least_sigma(LEAST_SIGMA)).map_err(Error::channel)
}

/// Where the user can be.
///
/// # Errors
/// None with these numbers.
pub fn region() -> Result<Region<f32, 2>, Error> {
    Region::new([0.0; 2], [SIDE; 2]).map_err(Error::filter)
}

/// How the user moves.
pub fn motion() -> Motion<f32> {
    Motion::people_measured_to(LEAST_SIGMA)
}
