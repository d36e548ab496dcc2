//! Precise satellite clocks: interpolation between samples.

use crate::GpsTime;

/// One sample of a satellite's clock.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClockSample {
    /// Seconds since the clock's reference instant.
    pub second: f64,
    /// Satellite clock minus GPS time, s, without the relativistic effect of the orbit's eccentricity, as in products
    /// of the IGS. NaN where the clock jumps: it is unknown between the neighbours of this sample.
    pub bias: f64,
}

/// A satellite's clock at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClockState {
    /// Satellite clock minus GPS time, s.
    pub bias: f64,
    /// The time between the neighbouring samples, s; zero on a sample.
    pub interval: f64,
    /// The time to the nearer neighbouring sample, s.
    pub distance: f64,
}

/// A satellite's precise clock: samples in chronological order.
#[derive(Clone, Copy, Debug)]
pub struct Clock<'a> {
    /// The reference instant of the samples' times.
    pub reference: GpsTime,
    /// The samples, in ascending order of time.
    pub samples: &'a [ClockSample],
    /// The longest gap between samples that is bridged, s.
    pub longest_gap: f64,
}

impl Clock<'_> {
    /// The clock at `time`, interpolated linearly between its neighbours; `None` outside the samples or in a gap.
    pub fn at(&self, time: GpsTime) -> Option<ClockState> {
        let second = time.since(self.reference);
        let after = self.samples.partition_point(|sample| sample.second <= second);
        let known = |place| self.samples.get(place).filter(|it: &&ClockSample| !it.bias.is_nan());
        let before = known(after.checked_sub(1)?)?;
        if before.second == second {
            return Some(ClockState { bias: before.bias, interval: 0.0, distance: 0.0 });
        }
        let next = known(after)?;
        let interval = next.second - before.second;
        if interval > self.longest_gap || interval.is_nan() {
            return None;
        }
        let elapsed = second - before.second;
        let share = elapsed / interval;
        Some(ClockState {
            bias: before.bias + share * (next.bias - before.bias),
            interval,
            distance: elapsed.min(interval - elapsed),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_samples_and_not_beyond() {
        let reference = GpsTime::new(59_025, 0.0);
        let samples = [(0.0, 1.0), (30.0, 2.0), (900.0, 3.0), (920.0, f64::NAN), (921.0, 7.0)]
            .map(|(second, bias)| ClockSample { second, bias });
        let clock = Clock { reference, samples: &samples, longest_gap: 300.0 };
        let at = |second| clock.at(reference.plus(second));
        assert_eq!(at(12.0), Some(ClockState { bias: 1.4, interval: 30.0, distance: 12.0 }));
        assert_eq!(at(900.0).map(|state| state.bias), Some(3.0));
        assert_eq!(at(30.0).map(|state| state.interval), Some(0.0));
        assert_eq!(at(921.0).map(|state| state.bias), Some(7.0));
        for missing in [-1.0, 31.0, 901.0, 920.0, 920.5, 922.0, f64::NAN] {
            assert_eq!(at(missing), None);
        }
    }
}
