use crate::Error;
use kestirim_kalman::Innovation;
use kestirim_scalar::Scalar;
use nalgebra::SVector;

/// One measured distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RangeSample<T> {
    /// Time of the measurement (µs since any moment).
    pub time_us: u64,
    /// Index of its anchor in the list that the tracker was made with.
    pub anchor: usize,
    /// The distance, m; small negative ones are accepted.
    pub range: T,
}

impl<T: Scalar> RangeSample<T> {
    /// Bounds of what a radio measures, m.
    const SHORTEST: f64 = -1.0;
    const LONGEST: f64 = 200.0;

    /// Refuses what no radio measures.
    #[inline]
    pub(crate) fn check(&self) -> Result<(), Error> {
        let plausible = T::from_f64(Self::SHORTEST)..=T::from_f64(Self::LONGEST);
        if plausible.contains(&self.range) {
            return Ok(());
        }
        Err(if self.range.is_finite() { Error::ImplausibleRange } else { Error::NotFinite })
    }
}

/// By how much one anchor is farther than another.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DifferenceSample<T> {
    /// When the message of the second anchor was received (µs since any moment).
    pub time_us: u64,
    /// Indices of two anchors in the list that the tracker was made with.
    pub anchors: [usize; 2],
    /// Distance to the second less distance to the first, m.
    pub difference: T,
}

impl<T: Scalar> DifferenceSample<T> {
    /// Refuses what no radio measures.
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
    /// Time of the measurement (µs since the same moment as the ranges).
    pub time_us: u64,
    /// Acceleration in the body's axes, with or without gravity, m/s². From the energy of its
    /// changes the tracker tells standing from moving.
    pub acceleration: SVector<T, 3>,
    /// The acceleration without gravity in the room's axes, m/s², if the prediction is to be driven by
    /// it (the paper's eq. 9). For a slow robot that does more harm than good.
    pub push: Option<[T; D]>,
}

/// Sample of the wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OdometrySample<T> {
    /// Time of the measurement (µs since the same moment as the ranges).
    pub time_us: u64,
    /// Mean speed of the wheels, m/s.
    pub speed: T,
    /// Difference of their speeds by the track, or the rate of a gyroscope beside them, rad/s. [`Tracker`](crate::Tracker)
    /// only reads from it whether the robot turns.
    pub turn_rate: T,
}

/// Outcome of a range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Outcome {
    /// The range is kept for a first position, for which more are needed, or which is looked for with each.
    Collected,
    /// With this range a first position was found, or a new one after the tracker was lost, from those of a moment or so ago.
    Started,
    /// The range was taken in with its full weight.
    Taken,
    /// The range was taken in with less weight: it is longer or shorter than expected.
    Weakened,
    /// The range was left out.
    Rejected,
    /// The range was taken in although it does not fit: too many had been left out.
    Recovered,
}

/// Outcome of a range, and its innovation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Report<T> {
    /// Its outcome.
    pub outcome: Outcome,
    /// Innovation (m), its variance and NIS, before any weakening; none without an estimate.
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
