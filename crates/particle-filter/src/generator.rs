//! The state of a generator of random numbers: an estimator that draws goes on as if it had not slept only if its
//! generator does, too.
//!
//! `#[serde(with = "kestirim_particle_filter::generator")]` is for a field of type [`Xoshiro128PlusPlus`]: its own serde
//! needs `std`.

use rand_core::SeedableRng;
use rand_xoshiro::Xoshiro128PlusPlus;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Writes 16 bytes.
///
/// # Errors
/// Those of the format.
pub fn serialize<S: Serializer>(
    generator: &Xoshiro128PlusPlus,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    generator.state().serialize(serializer)
}

/// Reads them; any will do.
///
/// # Errors
/// Those of the format.
pub fn deserialize<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Xoshiro128PlusPlus, D::Error> {
    <[u8; 16]>::deserialize(deserializer).map(Xoshiro128PlusPlus::from_seed)
}
