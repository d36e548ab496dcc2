//! A stream of an aeroplane's inputs and outputs.

use host_sim::random::{normal, stream};
use kestirim_luenberger::Plant;
use nalgebra::SVector;

use super::{Encode, record, words};

/// Elevator (rad), throttle, pitch rate (rad/s), airspeed (m/s) and pitch (rad) of each sample.
pub type Flight = [[f32; 5]];

impl Encode for Flight {
    fn encode(&self) -> Vec<u8> {
        self.iter().flat_map(|sample| record(1_000, words(sample))).collect()
    }
}

/// A thousand samples of a discrete plant with noise on inputs and outputs.
pub fn fly(plant: &Plant<4, 2, 3>) -> Vec<[f32; 5]> {
    let mut rng = stream(6, 0);
    let mut state = SVector::from([0.0, 0.0, 40.0, 0.53]);
    let moment = |_| {
        let outputs = plant.c * state;
        let measured = [0.0087, 0.5, 0.0087].map(|sigma| normal(&mut rng, sigma));
        let [rate, airspeed, pitch]: [f64; 3] = (outputs + SVector::from(measured)).into();
        let noise = SVector::from([0.0087, 0.02].map(|sigma| normal(&mut rng, sigma)));
        state = plant.a * state + plant.b * (SVector::from([0.025, 0.155]) + noise);
        [0.025, 0.155, rate, airspeed, pitch].map(|number| number as f32)
    };
    (0..1000).map(moment).collect()
}
