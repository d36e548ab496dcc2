//! Trackers for walks in progress.

use std::fmt::Debug;
use std::marker::PhantomData;

use kestirim_health::Health;
use kestirim_imu_calibration::{Calibration, Triad};
use kestirim_pedestrian::detector::StanceDetector;
use kestirim_pedestrian::{Ekf, Estimate, Lite, Navigator, Tracker};
use kestirim_scalar::{Components, Q12_20, Scalar};

use super::choices::{WithDetector, with_detector};
use super::walk::imu_sample;
use super::{Options, Sample, TrackerKind, sentences};
use crate::{Number, ScalarKind, Stored};

/// A tracker that follows a walk in progress, as [`walk`](super::walk) does for a complete one.
pub trait Follow: Debug {
    /// Processes a sample; returns false if the tracker rejects it.
    fn take(&mut self, sample: &Sample) -> bool;

    /// Ends the walk: no sample follows.
    fn finish(&mut self);

    /// The position of the foot, m; `None` before the first sample.
    fn position(&self) -> Option<[f64; 3]>;

    /// Whether the foot stands.
    fn is_still(&self) -> bool;

    /// The length of the path, m.
    fn path_length_m(&self) -> f64;

    /// The number of strides.
    fn strides(&self) -> u32;

    /// The warnings about the samples, in sentences.
    fn warnings(&self) -> Vec<String>;

    /// The doubts about the path; `None` before the first sample.
    fn health(&self) -> Option<Health>;

    /// The snapshot of everything that it needs to continue elsewhere, to the bit; `None` if it cannot be stored.
    fn snapshot(&self) -> Option<Vec<u8>>;

    /// Continues from a snapshot; `None`, and no change, if that is not one of such a tracker.
    fn restore(&mut self, snapshot: &[u8]) -> Option<()>;
}

/// Builds the chosen tracker, for samples of an IMU with the errors that its calibration describes.
pub fn build(options: &Options, calibration: Option<&Calibration<f64>>) -> Box<dyn Follow> {
    match options.scalar {
        ScalarKind::F32 => build_in::<f32>(options, calibration),
        ScalarKind::F64 => build_in::<f64>(options, calibration),
        ScalarKind::Fixed => build_in::<Q12_20>(options, calibration),
    }
}

fn build_in<T: Number + 'static>(
    options: &Options,
    calibration: Option<&Calibration<f64>>,
) -> Box<dyn Follow> {
    let calibration = calibration.map(cast);
    match options.tracker {
        TrackerKind::Lite => {
            with_detector(options, Built::<T, Lite<T>> { options, calibration, kind: PhantomData })
        }
        TrackerKind::Ekf => {
            with_detector(options, Built::<T, Ekf<T>> { options, calibration, kind: PhantomData })
        }
    }
}

/// Converts a calibration to another number type.
fn cast<T: Scalar>(calibration: &Calibration<f64>) -> Calibration<T> {
    let cast = |triad: &Triad<f64>| Triad {
        offset: triad.offset.map(T::from_f64),
        matrix: triad.matrix.map(T::from_f64),
    };
    Calibration {
        accelerometer: cast(&calibration.accelerometer),
        gyroscope: cast(&calibration.gyroscope),
    }
}

/// Builds a tracker around a detector.
struct Built<'a, T: Scalar, N> {
    options: &'a Options,
    calibration: Option<Calibration<T>>,
    kind: PhantomData<N>,
}

impl<T: Number + 'static, N: Navigator<T> + Stored + Debug + 'static> WithDetector<T>
    for Built<'_, T, N>
{
    type Output = Box<dyn Follow>;

    fn with<D: StanceDetector<T> + Stored + Debug + 'static>(self, detector: D) -> Box<dyn Follow> {
        let tracker = Tracker::<T, N, D>::with_detector(self.options.config(), detector);
        Box::new(Walker { tracker, calibration: self.calibration, last: None, strides: 0 })
    }
}

/// A causal tracker.
#[derive(Debug)]
struct Walker<T: Scalar, N, D> {
    tracker: Tracker<T, N, D>,
    calibration: Option<Calibration<T>>,
    last: Option<Estimate<T>>,
    strides: u32,
}

impl<T: Number, N: Navigator<T> + Stored + Debug, D: StanceDetector<T> + Stored + Debug> Follow
    for Walker<T, N, D>
{
    fn take(&mut self, sample: &Sample) -> bool {
        let mut sample = imu_sample(sample);
        if let Some(calibration) = &self.calibration {
            (sample.specific_force, sample.angular_rate) =
                calibration.apply(&sample.specific_force, &sample.angular_rate);
        }
        let Ok(estimate) = self.tracker.update(&sample) else { return false };
        self.strides += u32::from(estimate.stride.is_some());
        self.last = Some(estimate);
        true
    }

    fn finish(&mut self) {
        self.strides += u32::from(self.tracker.finish().is_some());
    }

    fn position(&self) -> Option<[f64; 3]> {
        self.last.as_ref().map(|estimate| estimate.position.as_array().map(T::to_f64))
    }

    fn is_still(&self) -> bool {
        self.last.as_ref().is_some_and(|estimate| estimate.stance)
    }

    fn path_length_m(&self) -> f64 {
        self.tracker.path_length().to_f64()
    }

    fn strides(&self) -> u32 {
        self.strides
    }

    fn warnings(&self) -> Vec<String> {
        // Whether the foot ever stood still is unknown before it did.
        if self.last.is_some() { sentences(self.tracker.warnings()) } else { Vec::new() }
    }

    fn health(&self) -> Option<Health> {
        self.last.as_ref().map(|_| self.tracker.warnings().health())
    }

    fn snapshot(&self) -> Option<Vec<u8>> {
        Some([&self.strides.to_le_bytes()[..], &self.tracker.stored()?].concat())
    }

    fn restore(&mut self, snapshot: &[u8]) -> Option<()> {
        let (strides, tracker) = snapshot.split_first_chunk()?;
        self.tracker = Stored::restored(tracker)?;
        // The next estimate comes with the next sample.
        (self.strides, self.last) = (u32::from_le_bytes(*strides), None);
        Some(())
    }
}
