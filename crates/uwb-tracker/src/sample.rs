use crate::Error;
use kestirim_kalman::Innovation;
use kestirim_scalar::Scalar;
use nalgebra::SVector;

/// One measured distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RangeSample<T> {
    /// Time of the measurement, µs since any epoch.
    pub time_us: u64,
    /// Index of the anchor in the list with which the tracker was created.
    pub anchor: usize,
    /// The distance, m; small negative values are accepted.
    pub range: T,
}

impl<T: Scalar> RangeSample<T> {
    /// Limits of a plausible range, m.
    const SHORTEST: f64 = -1.0;
    const LONGEST: f64 = 200.0;

    /// Checks that the range is one that a radio can measure.
    #[inline]
    pub(crate) fn check(&self) -> Result<(), Error> {
        let plausible = T::from_f64(Self::SHORTEST)..=T::from_f64(Self::LONGEST);
        if plausible.contains(&self.range) {
            return Ok(());
        }
        Err(if self.range.is_finite() { Error::ImplausibleRange } else { Error::NotFinite })
    }
}

/// The difference of a tag's distances to two anchors.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DifferenceSample<T> {
    /// Time at which the message of the second anchor was received, µs since any epoch.
    pub time_us: u64,
    /// Indices of the two anchors in the list with which the tracker was created.
    pub anchors: [usize; 2],
    /// Distance to the second anchor minus distance to the first, m.
    pub difference: T,
}

impl<T: Scalar> DifferenceSample<T> {
    /// Checks that the difference is one that a radio can measure.
    pub(crate) fn check(&self) -> Result<(), Error> {
        if self.difference.abs() <= T::from_f64(RangeSample::<T>::LONGEST) {
            return Ok(());
        }
        let is_finite = self.difference.is_finite();
        Err(if is_finite { Error::ImplausibleRange } else { Error::NotFinite })
    }
}

/// Sample of an IMU on the tag.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct InertialSample<T: Scalar, const D: usize> {
    /// Time of the measurement, µs since the same epoch as the ranges.
    pub time_us: u64,
    /// Acceleration in the body frame, with or without gravity, m/s². From the energy of its changes the tracker
    /// distinguishes standing from moving.
    pub acceleration: SVector<T, 3>,
    /// The acceleration without gravity in the room frame, m/s², if it is to drive the prediction (the paper's eq. 9).
    /// For a slow robot that does more harm than good. After a gap of more than a quarter of a second it is not used: for most of
    /// the gap the acceleration is not known.
    pub push: Option<[T; D]>,
}

/// Sample of wheel odometry.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OdometrySample<T> {
    /// Time of the measurement, µs since the same epoch as the ranges.
    pub time_us: u64,
    /// Mean speed of the wheels, m/s.
    pub speed: T,
    /// Turn rate: the difference of the wheels' speeds over the track, or the rate of a gyroscope, rad/s.
    /// [`Tracker`](crate::Tracker) only uses it to detect whether the robot turns.
    pub turn_rate: T,
}

/// Outcome of a range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Outcome {
    /// The range is stored for a first position, which needs more ranges, or is being searched for, a few steps per
    /// range.
    Collected,
    /// With this range a first position was found, or a new one after the tracker was lost; the ranges it is from may
    /// be slightly older.
    Started,
    /// The range was used with its full weight.
    Taken,
    /// The range was used with a reduced weight: it is longer or shorter than expected.
    Weakened,
    /// The range was rejected.
    Rejected,
    /// The range was used although it does not fit: too many had been rejected.
    Recovered,
}

/// The outcome of a range, and its innovation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Report<T> {
    /// What was done with the range.
    pub outcome: Outcome,
    /// Innovation (m), its variance and NIS, before any down-weighting; `None` without an estimate.
    pub innovation: Option<Innovation<T>>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_radio_measures_is_within_its_bounds() {
        let check = |range: f64| RangeSample { time_us: 0, anchor: 0, range }.check();
        for range in [-1.0, 0.0, 200.0] {
            assert_eq!(check(range), Ok(()), "{range}");
        }
        for range in [-1.001, 200.001] {
            assert_eq!(check(range), Err(Error::ImplausibleRange), "{range}");
        }
        for range in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(check(range), Err(Error::NotFinite), "{range}");
        }
    }
}
