//! The choices of a pedestrian tracker.

use std::fmt::Debug;

use kestirim_pedestrian::Config;
use kestirim_pedestrian::detector::{
    Adaptive, AngularRateEnergy, FixedShoe, Magnitude, MovingVariance, StanceDetector,
};
use kestirim_scalar::Scalar;

use super::STANDARD_GRAVITY;
use crate::{Number, ScalarKind, Stored};

/// All options of a tracker.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Architecture of the tracker.
    pub tracker: TrackerKind,
    /// The detector of stance.
    pub detector: DetectorKind,
    /// Class of the sensor: prior of its bias and noise.
    pub sensor: SensorClass,
    /// Height of the sensor above the ball of the foot, m; `None` is the tracker's default, or 0 with the detector of
    /// the paper, which forces all velocity to zero.
    pub contact_height_m: Option<f64>,
    /// Use past samples only, as firmware must.
    pub causal: bool,
    /// Correct the heading with the magnetometer, if there is one.
    pub magnetometer: bool,
    /// Distribute the correction at the end of each swing over that swing.
    pub smooth: bool,
    /// Number type of the estimator.
    pub scalar: ScalarKind,
}

impl Options {
    /// The published method: the paper's architecture and its threshold of 0.1 g.
    pub fn published() -> Self {
        Self {
            tracker: TrackerKind::Lite,
            detector: DetectorKind::Magnitude(DetectorKind::MAGNITUDE_THRESHOLD),
            ..Self::default()
        }
    }

    /// The published method to compare with these options: with the same threshold, if they have one, sensor and number
    /// type.
    pub fn published_beside(&self) -> Self {
        let detector = match self.detector {
            DetectorKind::Magnitude(_) => self.detector,
            _ => DetectorKind::Magnitude(DetectorKind::MAGNITUDE_THRESHOLD),
        };
        Self { detector, sensor: self.sensor, scalar: self.scalar, ..Self::published() }
    }

    /// The threshold of the magnitude detector, g; the paper's with another detector.
    pub fn magnitude_threshold_g(&self) -> f64 {
        match self.detector {
            DetectorKind::Magnitude(threshold) => threshold / STANDARD_GRAVITY,
            _ => Magnitude::<f64>::THRESHOLD_G,
        }
    }

    /// The height that the tracker assumes for the sensor, m; `None` is the tracker's default.
    pub fn contact_height_m(&self) -> Option<f64> {
        match (self.contact_height_m, self.detector) {
            (None, DetectorKind::Magnitude(_)) => Some(0.0),
            (height, _) => height,
        }
    }

    /// The settings from which a tracker is built.
    pub fn config<T: Scalar>(&self) -> Config<T> {
        let levels = self.detector == DetectorKind::Adaptive;
        let config = Config { sensor: self.sensor.into(), levels, ..Config::default() };
        match self.contact_height_m() {
            Some(height) => Config { contact_height: T::from_f64(height), ..config },
            None => config,
        }
    }

    /// The options with the sensor class that was found, unless one was chosen.
    #[must_use]
    pub fn with_sensor(&self, found: impl FnOnce() -> kestirim_pedestrian::SensorClass) -> Self {
        let sensor = match self.sensor {
            SensorClass::Found => SensorClass::from(found()),
            said => said,
        };
        Self { sensor, ..*self }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tracker: TrackerKind::default(),
            detector: DetectorKind::default(),
            sensor: SensorClass::default(),
            contact_height_m: None,
            causal: false,
            magnetometer: true,
            smooth: false,
            scalar: ScalarKind::F32,
        }
    }
}

/// The architecture of a tracker.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum TrackerKind {
    /// Error-state Kalman filter with zero-velocity updates
    #[default]
    Ekf,
    /// The paper's: attitude reference, integration, zero velocity in stance
    Lite,
}

/// The class of an IMU: the size of its bias and noise before anything is known.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum SensorClass {
    /// From what the gyroscope shows at rest; of a stream that is followed while it comes: consumer
    Found,
    /// Bare chips (MPU-6050, MPU-9250, the Razor): gyro bias about 0.1 rad/s
    #[default]
    Consumer,
    /// Calibrated units (Xsens, NGIMU, 3DM-GX): gyro bias about 3 mrad/s
    Industrial,
}

impl From<SensorClass> for kestirim_pedestrian::SensorClass {
    fn from(class: SensorClass) -> Self {
        match class {
            SensorClass::Industrial => Self::Industrial,
            SensorClass::Consumer | SensorClass::Found => Self::Consumer,
        }
    }
}

impl From<kestirim_pedestrian::SensorClass> for SensorClass {
    fn from(class: kestirim_pedestrian::SensorClass) -> Self {
        match class {
            kestirim_pedestrian::SensorClass::Industrial => Self::Industrial,
            kestirim_pedestrian::SensorClass::Consumer => Self::Consumer,
        }
    }
}

/// The detector of stance. Thresholds are in SI units; stance is below them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum DetectorKind {
    /// Threshold-free: compares with the quietest moments around.
    #[default]
    Adaptive,
    /// The paper's: deviation of the specific force's magnitude from 1 g, m/s².
    Magnitude(f64),
    /// Moving variance of the specific force, (m/s²)².
    Variance(f64),
    /// Mean square angular rate, (rad/s)².
    AngularRate(f64),
    /// Generalised likelihood ratio of both (SHOE), (rad/s)².
    Shoe(f64),
}

impl DetectorKind {
    /// The paper's threshold of 0.1 g, m/s².
    pub const MAGNITUDE_THRESHOLD: f64 = Magnitude::<f64>::THRESHOLD_G * STANDARD_GRAVITY;
    /// The default threshold of [`Self::Variance`], (m/s²)².
    pub const VARIANCE_THRESHOLD: f64 =
        MovingVariance::<f64>::THRESHOLD_G2 * STANDARD_GRAVITY * STANDARD_GRAVITY;
    /// The default threshold of [`Self::AngularRate`], (rad/s)².
    pub const ANGULAR_RATE_THRESHOLD: f64 = AngularRateEnergy::<f64>::THRESHOLD;
    /// The default threshold of [`Self::Shoe`], (rad/s)².
    pub const SHOE_THRESHOLD: f64 = FixedShoe::<f64>::THRESHOLD;

    /// The condition for stance, in words.
    pub fn in_words(self) -> String {
        match self {
            Self::Adaptive => "near the quietest moments around".to_owned(),
            Self::Magnitude(value) => {
                format!("|a| within {:.2} g of 1 g", value / STANDARD_GRAVITY)
            }
            Self::Variance(value) => format!("variance of |a| below {value:.3} (m/s²)²"),
            Self::AngularRate(value) => format!("mean |ω|² below {value:.3} (rad/s)²"),
            Self::Shoe(value) => format!("SHOE's T below {value:.3} (rad/s)²"),
        }
    }
}

/// Work that is generic over the detector.
pub(super) trait WithDetector<T: Scalar> {
    /// The result of the work.
    type Output;

    /// Does the work with a detector.
    fn with<D: StanceDetector<T> + Stored + Debug + 'static>(self, detector: D) -> Self::Output;
}

/// Does work with the chosen detector.
pub(super) fn with_detector<T: Number, W: WithDetector<T>>(
    options: &Options,
    work: W,
) -> W::Output {
    let threshold = T::from_f64;
    match options.detector {
        DetectorKind::Adaptive => work.with(Adaptive::default()),
        DetectorKind::Magnitude(value) => {
            work.with(Magnitude::new(threshold(value / STANDARD_GRAVITY)))
        }
        DetectorKind::Variance(value) => {
            work.with(MovingVariance::new(threshold(value / STANDARD_GRAVITY.powi(2))))
        }
        DetectorKind::AngularRate(value) => work.with(AngularRateEnergy::new(threshold(value))),
        DetectorKind::Shoe(value) => work.with(FixedShoe::new(threshold(value))),
    }
}
