//! A stream of path losses measured by a drone.

use std::f64::consts::TAU;

use host_sim::random::{normal, stream};
use kestirim_air_to_ground::{Channel, Environment};
use rand_core::Rng;

use super::{Encode, record, words};

/// The position of the user, m.
const USER: [f64; 2] = [1400.0, 700.0];
/// The height of the drone, m.
const HEIGHT: f64 = 500.0;
/// The wavelength, m.
const WAVELENGTH: f64 = 0.15;

/// The drone's x, y and height (m) and the path loss (dB), one record a second.
pub type Records = [[f32; 4]];

impl Encode for Records {
    fn encode(&self) -> Vec<u8> {
        self.iter().flat_map(|numbers| record(1_000_000, words(numbers))).collect()
    }
}

/// Two rounds about the centre of the city.
///
/// # Panics
/// The channel's constants make no sense.
pub fn circle() -> Vec<[f32; 4]> {
    let mut rng = stream(4, 0);
    let channel = Channel::<f64>::new(&Environment::urban(), WAVELENGTH).expect("a channel");
    let record = |step: u32| {
        let angle = TAU * f64::from(step) / 12.0;
        let place = [1000.0 + 667.0 * angle.cos(), 1000.0 + 667.0 * angle.sin()];
        let distance = (USER[0] - place[0]).hypot(USER[1] - place[1]);
        let expected = channel.path_loss(distance, HEIGHT).expect("a distance");
        let seen = rng.next_u32() as f64 / 2_f64.powi(32) < expected.line_of_sight_probability;
        let loss = if seen {
            expected.line_of_sight_mean + normal(&mut rng, expected.line_of_sight_sigma)
        } else {
            expected.obstructed_mean + normal(&mut rng, expected.obstructed_sigma)
        };
        [place[0], place[1], HEIGHT, loss].map(|number| number as f32)
    };
    (0..24).map(record).collect()
}
