//! Feeds a walk to the tracker, in the number type, mode and shape that were chosen.

use kestirim_pedestrian::detector::{
    Adaptive, AngularRateEnergy, FixedShoe, Magnitude, MovingVariance, StanceDetector,
};
use kestirim_pedestrian::{
    Config, Ekf, Estimate, ImuSample, Lite, Navigator, OfflineTracker, Tracker, Warnings,
};
use kestirim_scalar::{Q12_20, Scalar};
use nalgebra::SVector;

use super::options::{DetectorKind, Options, TrackerKind};
use super::track::TrackPoint;
use super::{STANDARD_GRAVITY, Sample};
use crate::cli::ScalarKind;

/// What a tracker makes of a walk, in the room frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Walk {
    /// One position for every sample.
    pub track: Vec<TrackPoint>,
    /// One entry for every stride, in order.
    pub strides: Vec<Stride>,
    /// Horizontal, stance to stance, m.
    pub path_length_m: f64,
    /// Horizontal distance from start to end, m.
    pub closure_m: f64,
    /// What is suspicious about the sensor or the walk.
    pub warnings: Vec<String>,
}

/// One stride of the foot, from stance to stance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stride {
    /// When the foot stands again, µs.
    pub time_us: u64,
    /// Where it stands then, m.
    pub position: [f64; 3],
    /// Horizontal distance from the stance before, m.
    pub length_m: f64,
    /// Time from the stance before, s.
    pub duration_s: f64,
    /// Turn with respect to the stride before, rad, anticlockwise.
    pub heading_change_rad: f64,
}

/// Why a tracker makes no walk of a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// Too short to integrate anything.
    #[error("expected a log of at least {needed} samples, found {found}")]
    TooShort {
        /// Samples of the log.
        found: usize,
        /// Samples it takes.
        needed: usize,
    },
    /// The tracker refuses a sample.
    #[error("sample {index}: {source}")]
    Sample {
        /// Counted from 1.
        index: usize,
        /// Why.
        source: kestirim_pedestrian::Error,
    },
}

/// Tracks a walk.
///
/// # Errors
/// If the log is too short or holds a sample that the tracker refuses.
pub fn walk(samples: &[Sample], options: &Options) -> Result<Walk, RunError> {
    if samples.len() < 2 {
        return Err(RunError::TooShort { found: samples.len(), needed: 2 });
    }
    match options.scalar {
        ScalarKind::F32 => with_scalar::<f32>(samples, options),
        ScalarKind::F64 => with_scalar::<f64>(samples, options),
        ScalarKind::Fixed => with_scalar::<Q12_20>(samples, options),
    }
}

fn with_scalar<T: Scalar>(samples: &[Sample], options: &Options) -> Result<Walk, RunError> {
    match options.tracker {
        TrackerKind::Lite => with_navigator::<T, Lite<T>>(samples, options),
        TrackerKind::Ekf => with_navigator::<T, Ekf<T>>(samples, options),
    }
}

fn with_navigator<T: Scalar, N: Navigator<T>>(
    samples: &[Sample],
    options: &Options,
) -> Result<Walk, RunError> {
    let samples: Vec<_> = samples.iter().map(imu_sample::<T>).collect();
    let mut config = Config { sensor: options.sensor.into(), ..Config::default() };
    match (options.contact_height_m, options.detector) {
        (Some(height), _) => config.contact_height = T::from_f64(height),
        (None, DetectorKind::Magnitude(_)) => config.contact_height = T::ZERO,
        (None, _) => {}
    }
    let threshold = T::from_f64;
    match options.detector {
        DetectorKind::Adaptive if options.causal => {
            causal::<T, N, _>(&samples, config, Adaptive::default())
        }
        DetectorKind::Adaptive => offline::<T, N>(&samples, config),
        DetectorKind::Magnitude(value) => {
            causal::<T, N, _>(&samples, config, Magnitude::new(threshold(value / STANDARD_GRAVITY)))
        }
        DetectorKind::Variance(value) => {
            let detector = MovingVariance::new(threshold(value / STANDARD_GRAVITY.powi(2)));
            causal::<T, N, _>(&samples, config, detector)
        }
        DetectorKind::AngularRate(value) => {
            causal::<T, N, _>(&samples, config, AngularRateEnergy::new(threshold(value)))
        }
        DetectorKind::Shoe(value) => {
            causal::<T, N, _>(&samples, config, FixedShoe::new(threshold(value)))
        }
    }
}

fn causal<T: Scalar, N: Navigator<T>, D: StanceDetector<T>>(
    samples: &[ImuSample<T>],
    config: Config<T>,
    detector: D,
) -> Result<Walk, RunError> {
    let mut tracker = Tracker::<T, N, D>::with_detector(config, detector);
    let mut walk = Walk::default();
    for (index, sample) in samples.iter().enumerate() {
        let estimate = tracker
            .update(sample)
            .map_err(|source| RunError::Sample { index: index + 1, source })?;
        walk.push(&estimate);
    }
    walk.finish(tracker.finish(), tracker.path_length(), tracker.warnings());
    Ok(walk)
}

fn offline<T: Scalar, N: Navigator<T>>(
    samples: &[ImuSample<T>],
    config: Config<T>,
) -> Result<Walk, RunError> {
    let mut unrest = vec![T::ZERO; samples.len()];
    let mut tracker = OfflineTracker::<T, N>::new(config, samples, &mut unrest)
        .map_err(|(index, source)| RunError::Sample { index: index + 1, source })?;
    let mut walk = Walk::default();
    for estimate in tracker.by_ref() {
        walk.push(&estimate);
    }
    walk.finish(tracker.finish(), tracker.path_length(), tracker.warnings());
    Ok(walk)
}

impl Walk {
    fn push<T: Scalar>(&mut self, estimate: &Estimate<T>) {
        let position = double(&estimate.position);
        self.track.push(TrackPoint { time_us: estimate.time_us, position });
        self.strides.extend(estimate.stride.as_ref().map(Stride::from_estimate));
    }

    fn finish<T: Scalar>(
        &mut self,
        last: Option<kestirim_pedestrian::Stride<T>>,
        path_length: T,
        warnings: Warnings,
    ) {
        self.strides.extend(last.as_ref().map(Stride::from_estimate));
        self.path_length_m = path_length.to_f64();
        if let Some(TrackPoint { position: [x, y, _], .. }) = self.track.last() {
            self.closure_m = x.hypot(*y);
        }
        self.warnings = sentences(warnings);
    }
}

impl Stride {
    fn from_estimate<T: Scalar>(stride: &kestirim_pedestrian::Stride<T>) -> Self {
        Self {
            time_us: stride.time_us,
            position: double(&stride.position),
            length_m: stride.length.to_f64(),
            duration_s: stride.duration.to_f64(),
            heading_change_rad: stride.heading_change.to_f64(),
        }
    }
}

fn imu_sample<T: Scalar>(sample: &Sample) -> ImuSample<T> {
    ImuSample {
        time_us: sample.time_us,
        specific_force: SVector::from(sample.specific_force.map(T::from_f64)),
        angular_rate: SVector::from(sample.angular_rate.map(T::from_f64)),
    }
}

fn double<T: Scalar>(vector: &SVector<T, 3>) -> [f64; 3] {
    vector.data.0[0].map(T::to_f64)
}

pub(crate) fn sentences(warnings: Warnings) -> Vec<String> {
    [
        (
            warnings.accelerometer_saturated,
            "the accelerometer saturated: choose a wider range than the walker's steps",
        ),
        (
            warnings.gyroscope_saturated,
            "the gyroscope saturated: choose a wider range than the walker's steps",
        ),
        (
            warnings.gravity_implausible,
            "at rest the accelerometer does not show 9.8 m/s²: wrong unit, or uncalibrated",
        ),
        (
            warnings.rate_implausible,
            "angular rates beyond any foot's: degrees a second where radians are expected?",
        ),
        (
            warnings.axes_inconsistent,
            "accelerometer and gyroscope contradict each other: axes swapped or mirrored?",
        ),
        (warnings.gaps, "samples are missing for more than 0.1 s"),
        (
            warnings.never_still,
            "no standstill of half a second was found: the gyro bias is unknown",
        ),
    ]
    .into_iter()
    .filter(|(raised, _)| *raised)
    .map(|(_, sentence)| sentence.to_owned())
    .collect()
}
