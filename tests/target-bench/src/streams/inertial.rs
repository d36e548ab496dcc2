//! A stream of an inertial sensor on a foot.

use host_sim::random::stream;
use host_sim::systems::pedestrian;
use host_sim::systems::pedestrian::simulate::scenario::Scenario;
use host_sim::systems::pedestrian::simulate::sensor;

use super::{Encode, record, words};

/// A sample of an inertial sensor, in its own axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The time since the previous sample, µs; for the first one, since the start.
    pub elapsed_us: u32,
    /// Specific force, m/s²: +1 g upwards at rest.
    pub specific_force: [f32; 3],
    /// Angular rate, rad/s.
    pub angular_rate: [f32; 3],
}

impl Encode for [Sample] {
    fn encode(&self) -> Vec<u8> {
        let sample = |sample: &Sample| {
            let numbers = [words(&sample.specific_force), words(&sample.angular_rate)];
            record(sample.elapsed_us, numbers.into_iter().flatten())
        };
        self.iter().flat_map(sample).collect()
    }
}

/// A walk of the paper's route with a Razor at 100 Hz, as its driver delivers it.
pub fn walk() -> Vec<Sample> {
    let mut rng = stream(7, 0);
    let rate_hz = 100.0;
    let ideal = Scenario::draw(&mut rng).ideal_imu(rate_hz);
    let measured = sensor::measure(&mut rng, &ideal, rate_hz);
    let mut last_us = 0;
    let sample = |sample: &pedestrian::Sample| {
        let elapsed_us = (sample.time_us - last_us) as u32;
        last_us = sample.time_us;
        Sample {
            elapsed_us,
            specific_force: sample.specific_force.map(|value| value as f32),
            angular_rate: sample.angular_rate.map(|value| value as f32),
        }
    };
    measured.iter().map(sample).collect()
}
