//! The site and the target of the search: the part to adapt first when copying this application.

use kestirim_air_to_ground::{Channel, Environment};
use kestirim_particle_filter::Region;
use kestirim_user_locator::Motion;

use crate::Error;

/// Latitude and longitude of the origin, degrees; x is east of it, y north.
pub const ORIGIN: [f64; 2] = [39.925_0, 32.836_9];
/// The height of the users' ground above sea level, m.
pub const GROUND: f32 = 890.0;
/// The side of the square that contains the user, from the origin eastwards and northwards, m.
pub const SIDE: f32 = 2_000.0;

/// The wavelength of the user's radio at 868 MHz, m.
pub const WAVELENGTH: f32 = 0.345;
/// The radiated level of the user's radio, including the gain of both antennas, dBm.
pub const LEVEL: f32 = 22.0;
/// The user's address.
pub const USER: u16 = 50;

/// The least standard deviation of a level, dB: the module reports whole ones.
const LEAST_SIGMA: f32 = 1.0;
/// The greatest age of a position that is combined with a level, µs.
pub(crate) const FRESH_US: u64 = 1_500_000;

/// The channel between radios in the air and on the ground of a city.
///
/// # Errors
/// None with these numbers.
pub fn channel() -> Result<Channel<f32>, Error> {
    let channel = Channel::new(&Environment::urban(), WAVELENGTH);
    channel.and_then(|channel| channel.with_least_sigma(LEAST_SIGMA)).map_err(Error::channel)
}

/// The region that contains the user.
///
/// # Errors
/// None with these numbers.
pub fn region() -> Result<Region<f32, 2>, Error> {
    Region::new([0.0; 2], [SIDE; 2]).map_err(Error::filter)
}

/// The motion model of the user.
pub fn motion() -> Motion<f32> {
    Motion::people_measured_to(LEAST_SIGMA)
}
