//! Simulates the drone's measurements with the thesis' channel.

use kestirim_air_to_ground::Channel;
use kestirim_replay::metrics::distance;
use rand_core::Rng;

use crate::random::{normal, uniform};

/// A path loss measured at height `height_m` above `place`, dB: with or without a line of sight, at random.
///
/// # Panics
/// The drone is not above the ground, or a place is nowhere.
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
