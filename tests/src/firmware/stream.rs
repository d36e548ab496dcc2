//! The recorded stream that an image reads. `tests/firmware/images/src/stream.rs` is its other end.

/// A sample of an inertial sensor, in its own axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Microseconds since the previous sample; of the first one, since the start.
    pub elapsed_us: u32,
    /// m/s²; at rest +1 g upwards.
    pub specific_force: [f32; 3],
    /// rad/s.
    pub angular_rate: [f32; 3],
}

/// Twenty-eight bytes a sample, little-endian, in the order of the fields.
pub fn encode(samples: &[Sample]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for sample in samples {
        bytes.extend(sample.elapsed_us.to_le_bytes());
        for number in sample.specific_force.iter().chain(&sample.angular_rate) {
            bytes.extend(number.to_le_bytes());
        }
    }
    bytes
}
