//! Serialisation of the state of a random number generator: an estimator that draws random numbers continues as if it
//! had not been stopped only if its generator does, too.
//!
//! Use `#[serde(with = "kestirim_particle_filter::generator")]` on a field of type [`Xoshiro128PlusPlus`], whose own
//! serde support needs `std`.

use rand_core::SeedableRng;
use rand_xoshiro::Xoshiro128PlusPlus;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Writes the 16 bytes of the generator's state.
///
/// # Errors
/// Those of the format.
pub fn serialize<S: Serializer>(
    generator: &Xoshiro128PlusPlus,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    generator.state().serialize(serializer)
}

/// Reads the 16 bytes of a generator's state; any bytes are valid.
///
/// # Errors
/// Those of the format.
pub fn deserialize<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Xoshiro128PlusPlus, D::Error> {
    <[u8; 16]>::deserialize(deserializer).map(Xoshiro128PlusPlus::from_seed)
}
