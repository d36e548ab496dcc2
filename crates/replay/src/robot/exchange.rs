//! Distances from the time stamps of two-way exchanges.

use kestirim_uwb_ranging::{DoubleSided, LevelBias, Timestamp};

/// The largest difference between two clocks, parts per million: beyond it, stamps of different exchanges were
/// combined.
const LARGEST_PPM: f64 = 100.0;

/// The six time stamps of a poll, a response and a final message, each sent and received.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Exchange(DoubleSided);

impl Exchange {
    /// An exchange with the readings of the two radios' counters, of which 40 bits are used.
    pub fn new(stamps: [u64; 6]) -> Self {
        let [a, b, c, d, e, f] = stamps.map(Timestamp::new);
        Self(DoubleSided::new(a, b, c, d, e, f))
    }

    /// The distance, m, corrected for the received level if that is known (dBm, as a DW1000 at 64 MHz estimates it);
    /// `None` if the stamps are not those of one exchange.
    pub fn metres(&self, level_dbm: Option<f64>) -> Option<f64> {
        let ppm: f64 = self.0.clock_offset().ok()?.ppm();
        let metres: f64 = self.0.asymmetric().ok()?;
        let bias = level_dbm.map_or(0.0, |level| LevelBias::dw1000_prf64().bias(level));
        (ppm.abs() <= LARGEST_PPM).then_some(metres - bias)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_of_two_exchanges_are_no_distance() {
        let mut stamps = [0, 500, 64_000_500, 64_000_570, 191_800_570, 191_802_070];
        let metres = Exchange::new(stamps).metres(None).unwrap();
        assert!((metres - 3.0).abs() < 3.0, "{metres}");
        // A weak signal is detected late, so the corrected distance is shorter by this much.
        let weak = Exchange::new(stamps).metres(Some(-95.0)).unwrap();
        assert!((metres - weak - 0.086).abs() < 1e-6, "{weak}");
        stamps[5] += 63_897_600;
        assert_eq!(Exchange::new(stamps).metres(None), None);
    }
}
