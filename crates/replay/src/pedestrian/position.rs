//! Positions over time.

/// A position at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackPoint {
    /// Time of the log's clock, µs.
    pub time_us: u64,
    /// Position, m, z up.
    pub position: [f64; 3],
}

impl TrackPoint {
    /// The position without its height, m.
    pub fn horizontal(&self) -> [f64; 2] {
        [self.position[0], self.position[1]]
    }
}

/// A place where the foot stood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Footprint {
    /// Time of the log's clock, µs.
    pub time_us: u64,
    /// Horizontal position, m, in any right-handed frame with z up.
    pub position: [f64; 2],
}

/// The position at a time, interpolated linearly between neighbours and held beyond the ends; `None` for an empty
/// track. Times must not decrease.
pub fn position_at(track: &[TrackPoint], time_us: u64) -> Option<[f64; 3]> {
    let after = track.partition_point(|point| point.time_us <= time_us);
    let next = track.get(after).or(track.last())?;
    let previous = if after == 0 { next } else { &track[after - 1] };
    let span = next.time_us - previous.time_us;
    if span == 0 {
        return Some(previous.position);
    }
    let share = (time_us - previous.time_us) as f64 / span as f64;
    let between =
        |i: usize| previous.position[i] + share * (next.position[i] - previous.position[i]);
    Some([between(0), between(1), between(2)])
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these values are exact")]
mod tests {
    use super::*;

    #[test]
    fn positions_are_interpolated_and_held() {
        let point = |time_us, x| TrackPoint { time_us, position: [x, 0.0, 0.0] };
        let track = [point(10, 1.0), point(20, 2.0), point(20, 3.0), point(30, 5.0)];
        let x_at = |time_us| position_at(&track, time_us).unwrap()[0];
        assert_eq!([5, 10, 15, 25, 30, 99].map(x_at), [1.0, 1.0, 1.5, 4.0, 5.0, 5.0]);
        assert_eq!(position_at(&[], 5), None);
    }
}
