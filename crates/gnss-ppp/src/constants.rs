//! Physical constants, SI.

/// Speed of light in vacuum, m/s.
pub const SPEED_OF_LIGHT: f64 = 299_792_458.0;
/// Rotation of the Earth in an inertial frame, rad/s (the value of the GPS interface specification).
pub const EARTH_ROTATION: f64 = 7.292_115_146_7e-5;
/// Geocentric gravitational constant, m³/s² (IERS Conventions 2010).
pub const EARTH_GRAVITY: f64 = 3.986_004_418e14;
/// Equatorial radius of the Earth, m (IERS Conventions 2010), to which the Love numbers refer.
pub const EARTH_RADIUS: f64 = 6_378_136.6;
/// Mass of the Sun over the mass of the Earth (IERS Conventions 2010).
pub const SUN_TO_EARTH_MASS: f64 = 332_946.048_2;
/// Mass of the Moon over the mass of the Earth (IERS Conventions 2010).
pub const MOON_TO_EARTH_MASS: f64 = 0.012_300_037_1;
/// Astronomical unit, m (IAU 2012).
pub const ASTRONOMICAL_UNIT: f64 = 149_597_870_700.0;
/// Terrestrial time minus GPS time, s.
pub const TERRESTRIAL_MINUS_GPS: f64 = 51.184;
