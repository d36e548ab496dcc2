//! What can be turned, and what it means.

use clap::ValueEnum;

use super::super::STANDARD_GRAVITY;
use super::super::options::{DetectorKind, Options, SensorClass, TrackerKind};
use crate::cli::ScalarKind;
use crate::explore::{Control, Settings};

/// Everything, standing as the command line would have it.
pub(super) fn all() -> Vec<Control> {
    let [low, high] = [0.05, 0.5];
    vec![
        Control::choice(
            "tracker",
            "tracker",
            &[("ekf", "error-state Kalman filter"), ("lite", "the paper's architecture")],
        ),
        Control::choice(
            "detector",
            "stance detector",
            &[
                ("adaptive", "adaptive, no threshold"),
                ("magnitude", "magnitude |a|, the paper's"),
                ("variance", "variance of |a|"),
                ("angular-rate", "angular rate"),
                ("shoe", "SHOE, fixed threshold"),
            ],
        ),
        Control::slider("threshold", "threshold of |a| about 1 g", "g", [low, high, 0.01], 0.1),
        Control::decades(
            "factor",
            "thresholds of variance, angular rate and SHOE, times their defaults",
            "",
            [0.1, 10.0],
            1.0,
        ),
        Control::choice(
            "sensor",
            "class of the sensor",
            &[("consumer", "consumer: bare chips"), ("industrial", "industrial: calibrated")],
        ),
        Control::slider(
            "contact_height",
            "sensor above the ball of the foot; 0 takes the foot for motionless, as the paper does",
            "m",
            [0.0, 0.2, 0.01],
            0.07,
        ),
        Control::switch("causal", "look only backwards, as firmware must", false),
        Control::choice(
            "scalar",
            "number type",
            &[("f32", "f32"), ("f64", "f64"), ("fixed", "fixed point, Q12.20")],
        ),
    ]
}

/// The tracker as the controls stand.
pub(super) fn options(settings: &Settings) -> Options {
    let default = Options::default();
    let factor = settings.number("factor");
    let detector = match settings.choice("detector") {
        "magnitude" => DetectorKind::Magnitude(settings.number("threshold") * STANDARD_GRAVITY),
        "variance" => DetectorKind::Variance(factor * DetectorKind::VARIANCE_THRESHOLD),
        "angular-rate" => DetectorKind::AngularRate(factor * DetectorKind::ANGULAR_RATE_THRESHOLD),
        "shoe" => DetectorKind::Shoe(factor * DetectorKind::SHOE_THRESHOLD),
        _ => DetectorKind::Adaptive,
    };
    let exactly = false;
    Options {
        tracker: TrackerKind::from_str(settings.choice("tracker"), exactly).unwrap_or_default(),
        detector,
        sensor: SensorClass::from_str(settings.choice("sensor"), exactly).unwrap_or_default(),
        contact_height_m: Some(settings.number("contact_height")),
        causal: settings.is_on("causal"),
        scalar: ScalarKind::from_str(settings.choice("scalar"), exactly).unwrap_or(default.scalar),
    }
}

/// When the foot is taken to stand.
pub(super) fn in_words(detector: DetectorKind) -> String {
    match detector {
        DetectorKind::Adaptive => "near the quietest moments around".to_owned(),
        DetectorKind::Magnitude(value) => {
            format!("|a| within {:.2} g of 1 g", value / STANDARD_GRAVITY)
        }
        DetectorKind::Variance(value) => format!("variance of |a| below {value:.3} (m/s²)²"),
        DetectorKind::AngularRate(value) => format!("mean |ω|² below {value:.3} (rad/s)²"),
        DetectorKind::Shoe(value) => format!("SHOE's T below {value:.3} (rad/s)²"),
    }
}
