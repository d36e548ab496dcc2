//! How a walk is tracked: what can be set, and what it means.

use clap::ValueEnum;
use kestirim_pedestrian::detector::{AngularRateEnergy, FixedShoe, Magnitude, MovingVariance};

use crate::metrics::STANDARD_GRAVITY;
use crate::system::{Given, Idle, Literal, ScalarKind, Setting, SettingValue, Settings, Shorthand};

/// Number types the tracker is built for.
pub const SCALARS: [ScalarKind; 3] = [ScalarKind::F32, ScalarKind::F64, ScalarKind::Fixed];

/// Least and greatest multiple of a detector's default threshold.
const FACTORS: [f64; 2] = [1e-6, 1e6];

/// What can be set, for a recording that can be averaged down to these rates, Hz.
pub(super) fn table(rates: Option<[f64; 3]>) -> Vec<Setting> {
    let rates = rates.unwrap_or([1.0, 10_000.0, 1.0]);
    vec![
        Setting::one_of("tracker", "Architecture of the tracker", &TrackerKind::default()).live(),
        Setting::one_of("detector", "How stance is recognised", &DetectorName::default())
            .shorthand(Shorthand { form: "NAME[:THRESHOLD]", read: read_detector })
            .live(),
        Setting::number(
            "threshold",
            "Threshold of the detector magnitude about 1 g",
            "g",
            [0.01, 1.0, 0.01],
            Magnitude::<f64>::THRESHOLD_G,
        )
        .live(),
        Setting::decades(
            "factor",
            "Thresholds of the detectors variance, angular-rate and shoe, times their defaults",
            "",
            FACTORS,
            1.0,
        )
        .live(),
        Setting::one_of("sensor", "Class of the sensor", &SensorClass::Found).live(),
        Setting::number(
            "contact-height",
            "Height of the sensor above the ball of the foot, about which the foot rolls in stance; 0 takes it for \
             motionless [default: 0.07 m, and 0 with the detector magnitude, as in the paper]",
            "m",
            [0.0, 0.5, 0.01],
            0.07,
        )
        .undecided()
        .live(),
        Setting::switch("causal", "Look only backwards, as firmware must", false),
        Setting::switch(
            "magnetometer",
            "Correct the heading where the foot stands twice in the same magnetic field, if the log has one; not causally",
            true,
        ),
        Setting::number("rate", "Average the log down to this rate first", "Hz", rates, rates[1])
            .undecided(),
        Setting::some_of("scalar", "Number type of the tracker", &SCALARS, &ScalarKind::F32).live(),
    ]
}

/// Why a setting has no effect as the others are, for a log that has a magnetometer or not, if that is known.
pub(super) fn idle(has_field: Option<bool>, settings: &Settings, name: &str) -> Option<Idle> {
    let detector = settings.chosen("detector");
    let scaled = [DetectorName::Variance, DetectorName::AngularRate, DetectorName::Shoe];
    match name {
        "threshold" if detector != DetectorName::Magnitude => {
            Some(Idle::foreign("is for --detector magnitude"))
        }
        "factor" if !scaled.contains(&detector) => {
            Some(Idle::foreign("is for --detector variance, angular-rate or shoe"))
        }
        "magnetometer" if !turns_back(settings) => {
            Some(Idle::foreign("is for --tracker ekf and --detector adaptive, without --causal"))
        }
        "magnetometer" if has_field == Some(false) => {
            Some(Idle::implied("is of no use: the log has no magnetometer"))
        }
        "causal" if detector != DetectorName::Adaptive => {
            Some(Idle::implied("is what every detector but adaptive does anyway"))
        }
        _ => None,
    }
}

/// Whether a magnetometer may correct the heading: that of the other trackers does not drift at a constant rate.
fn turns_back(settings: &Settings) -> bool {
    settings.chosen::<TrackerKind>("tracker") == TrackerKind::Ekf
        && settings.chosen::<DetectorName>("detector") == DetectorName::Adaptive
        && !settings.is_on("causal")
}

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
    /// Correct the heading by a magnetometer, if there is one.
    pub magnetometer: bool,
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

    /// The published method beside this one: with its threshold, if it has one, its sensor and its numbers.
    pub(super) fn published_beside(&self) -> Self {
        let detector = match self.detector {
            DetectorKind::Magnitude(_) => self.detector,
            _ => DetectorKind::Magnitude(DetectorKind::MAGNITUDE_THRESHOLD),
        };
        Self { detector, sensor: self.sensor, scalar: self.scalar, ..Self::published() }
    }

    /// The threshold of the detector magnitude, g; the paper's with another detector.
    pub(super) fn magnitude_threshold_g(&self) -> f64 {
        match self.detector {
            DetectorKind::Magnitude(threshold) => threshold / STANDARD_GRAVITY,
            _ => Magnitude::<f64>::THRESHOLD_G,
        }
    }

    /// As set.
    pub fn of(settings: &Settings) -> Self {
        let factor = settings.decided("factor");
        let detector = match settings.chosen("detector") {
            DetectorName::Adaptive => DetectorKind::Adaptive,
            DetectorName::Magnitude => {
                DetectorKind::Magnitude(settings.decided("threshold") * STANDARD_GRAVITY)
            }
            DetectorName::Variance => {
                DetectorKind::Variance(factor * DetectorKind::VARIANCE_THRESHOLD)
            }
            DetectorName::AngularRate => {
                DetectorKind::AngularRate(factor * DetectorKind::ANGULAR_RATE_THRESHOLD)
            }
            DetectorName::Shoe => DetectorKind::Shoe(factor * DetectorKind::SHOE_THRESHOLD),
        };
        Self {
            tracker: settings.chosen("tracker"),
            detector,
            sensor: settings.chosen("sensor"),
            contact_height_m: settings.number("contact-height"),
            causal: settings.is_on("causal"),
            magnetometer: settings.is_on("magnetometer") && turns_back(settings),
            scalar: settings.chosen("scalar"),
        }
    }

    /// The height that the tracker takes the sensor for, m; none is its own.
    pub(super) fn contact_height_m(&self) -> Option<f64> {
        match (self.contact_height_m, self.detector) {
            (None, DetectorKind::Magnitude(_)) => Some(0.0),
            (height, _) => height,
        }
    }

    /// With the class that is found, unless it is said.
    #[must_use]
    pub(super) fn with_sensor(
        &self,
        found: impl FnOnce() -> kestirim_pedestrian::SensorClass,
    ) -> Self {
        let sensor = match self.sensor {
            SensorClass::Found => SensorClass::from(found()),
            said => said,
        };
        Self { sensor, ..*self }
    }

    /// The same in firmware.
    pub(super) fn firmware(&self) -> String {
        let (scalar, number) =
            (Literal::number_type(self.scalar), |value| Literal::number(self.scalar, value));
        let config = format!("Config::<{scalar}>");
        let mut literal =
            Literal::new("kestirim_pedestrian::Config", self.scalar, &config, "Config::default()")
                .number_field("contact_height", self.contact_height_m());
        if self.sensor == SensorClass::Industrial {
            literal = literal
                .import("kestirim_pedestrian::SensorClass")
                .field("sensor", format!("SensorClass::{:?}", self.sensor));
        }
        if self.detector != DetectorKind::Adaptive {
            literal = literal.field("levels", "false".to_owned());
        }
        let detector = match self.detector {
            DetectorKind::Adaptive => None,
            DetectorKind::Magnitude(value) => Some(("Magnitude", value / STANDARD_GRAVITY)),
            DetectorKind::Variance(value) => {
                Some(("MovingVariance", value / STANDARD_GRAVITY.powi(2)))
            }
            DetectorKind::AngularRate(value) => Some(("AngularRateEnergy", value)),
            DetectorKind::Shoe(value) => Some(("FixedShoe", value)),
        };
        let navigator = format!("{:?}", self.tracker);
        let literal = literal
            .import("kestirim_pedestrian::Tracker")
            .import(&format!("kestirim_pedestrian::{navigator}"));
        let tracker = format!("let tracker = Tracker::<{scalar}, {navigator}<{scalar}>");
        match detector {
            None => literal.then(format!("{tracker}>::new(config);")),
            Some((detector, threshold)) => {
                let threshold = number(threshold);
                literal.import(&format!("kestirim_pedestrian::detector::{detector}")).then(format!(
                    "{tracker}, _>::with_detector(config, {detector}::new({threshold}));"
                ))
            }
        }
        .to_string()
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
            scalar: ScalarKind::F32,
        }
    }
}

/// Architecture of a tracker.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum TrackerKind {
    /// Error-state Kalman filter with zero-velocity updates
    #[default]
    Ekf,
    /// The paper's: attitude reference, integration, zero velocity in stance
    Lite,
}

/// Class of an IMU: how large its bias and noise are before anything is known.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
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

/// The name of a stance detector.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum DetectorName {
    /// Adaptive: compares with the quietest moments around, no threshold
    #[default]
    Adaptive,
    /// The paper's: the magnitude of the specific force is near 1 g
    Magnitude,
    /// Moving variance of the specific force
    Variance,
    /// Mean square angular rate
    AngularRate,
    /// Generalised likelihood ratio of both (SHOE)
    Shoe,
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

    /// When the foot is taken to stand.
    pub(super) fn in_words(self) -> String {
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

/// Reads `NAME:THRESHOLD`; none without a colon. The threshold of `magnitude` is in g, as in the paper; those
/// of the others are in the units of [`DetectorKind`].
fn read_detector(text: &str) -> Option<Result<Given, String>> {
    let (name, threshold) = text.split_once(':')?;
    let threshold = threshold.parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0);
    Some(detector_with(name, threshold))
}

fn detector_with(name: &str, threshold: Option<f64>) -> Result<Given, String> {
    let default = match name {
        "magnitude" => Magnitude::<f64>::THRESHOLD_G,
        "variance" => DetectorKind::VARIANCE_THRESHOLD,
        "angular-rate" => DetectorKind::ANGULAR_RATE_THRESHOLD,
        "shoe" => DetectorKind::SHOE_THRESHOLD,
        "adaptive" => return Err("adaptive needs no threshold".to_owned()),
        _ => {
            return Err("expected adaptive, magnitude, variance, angular-rate or shoe, \
                        all but the first with a threshold or without, as in magnitude:0.1"
                .to_owned());
        }
    };
    let threshold = threshold.ok_or("expected a positive number after the colon")?;
    let (setting, value, [least, most]) = if name == "magnitude" {
        ("threshold", threshold, [0.01, 1.0])
    } else {
        ("factor", threshold / default, FACTORS)
    };
    if !(least..=most).contains(&value) {
        let unit = threshold / value;
        return Err(format!("expected a threshold from {} to {}", least * unit, most * unit));
    }
    let name = SettingValue::Text(name.to_owned());
    Ok(vec![("detector", name), (setting, SettingValue::Number(value))])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn detector(text: &str) -> Result<DetectorKind, crate::Error> {
        let mut settings = Settings::new(table(None));
        settings.set("detector", text)?;
        Ok(Options::of(&settings).detector)
    }

    #[test]
    fn nothing_set_is_the_default_but_for_the_sensor_which_is_found() {
        let options = Options::of(&Settings::new(table(None)));
        assert_eq!(options.sensor, SensorClass::Found);
        let consumer = options.with_sensor(|| kestirim_pedestrian::SensorClass::Consumer);
        assert_eq!(consumer, Options::default());
    }

    #[test]
    fn detectors_are_read_with_and_without_threshold() {
        assert_eq!(detector("adaptive").unwrap(), DetectorKind::Adaptive);
        assert_eq!(detector("magnitude:0.1").unwrap(), detector("magnitude").unwrap());
        for (text, expected) in [("variance:2", 2.0), ("angular-rate:2", 2.0), ("shoe:1e5", 1e5)] {
            let (DetectorKind::Variance(value)
            | DetectorKind::AngularRate(value)
            | DetectorKind::Shoe(value)) = detector(text).unwrap()
            else {
                panic!("{text}")
            };
            assert!((value / expected - 1.0).abs() < 1e-15, "{text}: {value}");
        }
    }

    #[test]
    fn wrong_detectors_are_refused() {
        for text in ["", "glrt", "shoe:", "shoe:x", "shoe:NaN", "shoe:-1", "shoe:inf", "adaptive:1"]
        {
            assert!(detector(text).is_err(), "{text}");
        }
    }

    #[test]
    fn heights_are_metres() {
        for text in ["", "x", "-0.1", "NaN", "inf", "7"] {
            assert!(Settings::new(table(None)).set("contact-height", text).is_err(), "{text}");
        }
    }
}
