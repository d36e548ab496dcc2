//! How a walk is tracked: what the command line can choose.

use clap::ValueEnum;
use kestirim_pedestrian::detector::{AngularRateEnergy, FixedShoe, Magnitude, MovingVariance};

use super::STANDARD_GRAVITY;
use crate::cli::ScalarKind;

/// Number types the tracker is built for.
pub const SCALARS: [ScalarKind; 3] = [ScalarKind::F32, ScalarKind::F64, ScalarKind::Fixed];

/// Everything that can be chosen about a tracker.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Architecture of the tracker.
    pub tracker: TrackerKind,
    /// How stance is recognised.
    pub detector: DetectorKind,
    /// Class of the sensor: prior of its bias and noise.
    pub sensor: SensorClass,
    /// Height of the sensor above the ball of the foot, m; none is the tracker's default, and 0 with the
    /// detector of the paper, which forces all velocity to zero.
    pub contact_height_m: Option<f64>,
    /// Look only backwards, as firmware must.
    pub causal: bool,
    /// Number type of the estimator.
    pub scalar: ScalarKind,
}

impl Options {
    /// The method of the paper, literally: its architecture and its threshold of 0.1 g.
    pub fn of_the_paper() -> Self {
        Self {
            tracker: TrackerKind::Lite,
            detector: DetectorKind::Magnitude(DetectorKind::MAGNITUDE_THRESHOLD),
            ..Self::default()
        }
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
            scalar: ScalarKind::F32,
        }
    }
}

/// Architecture of a tracker.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum TrackerKind {
    /// The paper's: attitude reference, integration, zero velocity in stance
    Lite,
    /// Error-state Kalman filter with zero-velocity updates
    #[default]
    Ekf,
}

/// Class of an IMU: how large its bias and noise are before anything is known.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum SensorClass {
    /// Calibrated units (Xsens, NGIMU, 3DM-GX): gyro bias about 3 mrad/s
    Industrial,
    /// Bare chips (MPU-6050, MPU-9250, the Razor): gyro bias about 0.1 rad/s
    #[default]
    Consumer,
}

impl From<SensorClass> for kestirim_pedestrian::SensorClass {
    fn from(class: SensorClass) -> Self {
        match class {
            SensorClass::Industrial => Self::Industrial,
            SensorClass::Consumer => Self::Consumer,
        }
    }
}

/// How stance is recognised; thresholds in SI, stance is below.
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
    /// Default of [`Self::Variance`], (m/s²)².
    pub const VARIANCE_THRESHOLD: f64 =
        MovingVariance::<f64>::THRESHOLD_G2 * STANDARD_GRAVITY * STANDARD_GRAVITY;
    /// Default of [`Self::AngularRate`], (rad/s)².
    pub const ANGULAR_RATE_THRESHOLD: f64 = AngularRateEnergy::<f64>::THRESHOLD;
    /// Default of [`Self::Shoe`], (rad/s)².
    pub const SHOE_THRESHOLD: f64 = FixedShoe::<f64>::THRESHOLD;
}

/// Reads `NAME[:THRESHOLD]`. The threshold of `magnitude` is in g, as in the paper; those of the
/// others are in the units of [`DetectorKind`].
///
/// # Errors
/// A sentence that says what was expected.
pub fn parse_detector(text: &str) -> Result<DetectorKind, String> {
    let (name, threshold) = match text.split_once(':') {
        Some((name, threshold)) => (name, Some(parse_threshold(threshold)?)),
        None => (text, None),
    };
    match (name, threshold) {
        ("adaptive", None) => Ok(DetectorKind::Adaptive),
        ("adaptive", Some(_)) => Err("adaptive needs no threshold".to_owned()),
        ("magnitude", g) => Ok(DetectorKind::Magnitude(
            g.map_or(DetectorKind::MAGNITUDE_THRESHOLD, |g| g * STANDARD_GRAVITY),
        )),
        ("variance", value) => {
            Ok(DetectorKind::Variance(value.unwrap_or(DetectorKind::VARIANCE_THRESHOLD)))
        }
        ("angular-rate", value) => {
            Ok(DetectorKind::AngularRate(value.unwrap_or(DetectorKind::ANGULAR_RATE_THRESHOLD)))
        }
        ("shoe", value) => Ok(DetectorKind::Shoe(value.unwrap_or(DetectorKind::SHOE_THRESHOLD))),
        _ => Err("expected adaptive, magnitude, variance, angular-rate or shoe, \
                  all but the first with a threshold or without, as in magnitude:0.1"
            .to_owned()),
    }
}

/// Reads a height of up to half a metre.
///
/// # Errors
/// A sentence that says what was expected.
pub fn parse_contact_height(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=0.5).contains(&value) => Ok(value),
        _ => Err("expected metres from 0 to 0.5".to_owned()),
    }
}

fn parse_threshold(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("expected a positive number after the colon".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn detectors_are_read_with_and_without_threshold() {
        assert_eq!(parse_detector("adaptive"), Ok(DetectorKind::Adaptive));
        assert_eq!(parse_detector("magnitude:0.1"), parse_detector("magnitude"));
        assert_eq!(parse_detector("variance:2"), Ok(DetectorKind::Variance(2.0)));
        assert_eq!(parse_detector("angular-rate:2"), Ok(DetectorKind::AngularRate(2.0)));
        assert_eq!(parse_detector("shoe:1e5"), Ok(DetectorKind::Shoe(1e5)));
    }

    #[test]
    fn contact_heights_are_metres() {
        assert_eq!(parse_contact_height("0.05"), Ok(0.05));
        for text in ["", "x", "-0.1", "NaN", "inf", "7"] {
            assert!(parse_contact_height(text).is_err(), "{text}");
        }
    }

    #[test]
    fn wrong_detectors_are_refused() {
        for text in ["", "glrt", "shoe:", "shoe:x", "shoe:NaN", "shoe:-1", "shoe:inf", "adaptive:1"]
        {
            assert!(parse_detector(text).is_err(), "{text}");
        }
    }
}
