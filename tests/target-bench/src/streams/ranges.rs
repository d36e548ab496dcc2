//! A stream of ultra-wideband ranges, one at a time.

use host_sim::random::{normal, stream};

use super::{Encode, record};

/// The positions of the images' anchors, m.
pub const PLACES: [[f64; 3]; 8] = [
    [0.0, 0.0, 2.5],
    [10.0, 0.0, 2.0],
    [10.0, 8.0, 2.5],
    [0.0, 8.0, 2.0],
    [5.0, 0.0, 0.5],
    [10.0, 4.0, 0.2],
    [5.0, 8.0, 0.5],
    [0.0, 4.0, 0.2],
];

/// The time since the range before (µs), the anchor and the range (m).
pub type Ranges = [(u32, usize, f32)];

impl Encode for Ranges {
    fn encode(&self) -> Vec<u8> {
        let range = |&(elapsed_us, anchor, range): &(u32, usize, f32)| {
            record(elapsed_us, [(anchor as u32).to_le_bytes(), range.to_le_bytes()])
        };
        self.iter().flat_map(range).collect()
    }
}

/// The ranges of a tag on an ellipse among the first `anchors` anchors, in epochs of 0.1 s: with noise of 5 cm,
/// reflections and outliers.
pub fn ellipse(anchors: usize) -> Vec<(u32, usize, f32)> {
    let mut rng = stream(3, 0);
    let mut samples = Vec::new();
    for epoch in 0..300_u32 {
        let angle = 0.03 * f64::from(epoch);
        let tag = [5.0 + 3.0 * angle.cos(), 4.0 + 2.0 * angle.sin(), 1.0];
        for (anchor, place) in PLACES.iter().enumerate().take(anchors) {
            let squares: f64 = place.iter().zip(tag).map(|(a, b)| (a - b).powi(2)).sum();
            let kind = normal(&mut rng, 1.0).abs();
            let excess = if kind > 2.5 {
                10.0
            } else if kind > 1.9 {
                kind
            } else {
                0.0
            };
            let range = squares.sqrt() + normal(&mut rng, 0.05) + excess;
            let elapsed_us = if anchor == 0 { 100_000 } else { 0 };
            samples.push((elapsed_us, anchor, range as f32));
        }
    }
    samples
}
