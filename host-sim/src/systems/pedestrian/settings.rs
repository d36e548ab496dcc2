//! The settings of the tracking of a walk.

use clap::ValueEnum;
use kestirim_pedestrian::detector::Magnitude;
use kestirim_replay::ScalarKind;
use kestirim_replay::pedestrian::{DetectorKind, Options, SensorClass, TrackerKind};

use crate::metrics::STANDARD_GRAVITY;
use crate::system::{Given, Idle, Literal, Setting, SettingValue, Settings, Shorthand};

/// The minimum and maximum multiple of a detector's default threshold.
const FACTORS: [f64; 2] = [1e-6, 1e6];

/// The conditions of a correction after the walk, in words.
pub(super) const LOOKING_BACK: &str =
    "is for --tracker ekf and --detector adaptive, without --causal";

/// The available settings, for a recording that can be averaged down to these rates (Hz).
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
            "Correct the heading where the foot stands twice in the same magnetic field, if the log has one, looking back",
            true,
        ),
        Setting::switch(
            "right-angles",
            "The walk goes along walls at right angles: correct the heading by that, or say that it does not",
            false,
        ),
        Setting::switch(
            "closed",
            "The walk ends where it began, within about 0.1 m: correct heading, scale and height by that",
            false,
        ),
        Setting::switch(
            "smooth",
            "Take back over each swing what its end corrects, so that no foot jumps as it lands (not for firmware)",
            false,
        ),
        Setting::number("rate", "Average the log down to this rate first", "Hz", rates, rates[1])
            .undecided(),
        Setting::one_of("scalar", "Number type of the tracker", &ScalarKind::F32).live(),
    ]
}

/// Why a setting has no effect given the others, for a log with or without a magnetometer, if that is known.
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
        "magnetometer" | "right-angles" | "closed" if !turns_back(settings) => {
            Some(Idle::foreign(LOOKING_BACK))
        }
        "magnetometer" if has_field == Some(false) => {
            Some(Idle::implied("is of no use: the log has no magnetometer"))
        }
        "smooth" if settings.is_on("causal") => {
            Some(Idle::foreign("looks ahead: not with --causal"))
        }
        "causal" if detector != DetectorName::Adaptive => {
            Some(Idle::implied("is what every detector but adaptive does anyway"))
        }
        _ => None,
    }
}

/// Whether the heading may be corrected after the walk: that of the other trackers does not drift at a constant rate.
pub(super) fn turns_back(settings: &Settings) -> bool {
    settings.chosen::<TrackerKind>("tracker") == TrackerKind::Ekf
        && settings.chosen::<DetectorName>("detector") == DetectorName::Adaptive
        && !settings.is_on("causal")
}

/// Whether the walk is declared to follow walls at right angles.
pub(super) fn is_at_right_angles(settings: &Settings) -> bool {
    settings.is_on("right-angles") && turns_back(settings)
}

/// Whether the walk is declared to end where it began.
pub(super) fn is_closed(settings: &Settings) -> bool {
    settings.is_on("closed") && turns_back(settings)
}

/// The options of the tracker.
pub fn options(settings: &Settings) -> Options {
    let factor = settings.decided("factor");
    let detector = match settings.chosen("detector") {
        DetectorName::Adaptive => DetectorKind::Adaptive,
        DetectorName::Magnitude => {
            DetectorKind::Magnitude(settings.decided("threshold") * STANDARD_GRAVITY)
        }
        DetectorName::Variance => DetectorKind::Variance(factor * DetectorKind::VARIANCE_THRESHOLD),
        DetectorName::AngularRate => {
            DetectorKind::AngularRate(factor * DetectorKind::ANGULAR_RATE_THRESHOLD)
        }
        DetectorName::Shoe => DetectorKind::Shoe(factor * DetectorKind::SHOE_THRESHOLD),
    };
    Options {
        tracker: settings.chosen("tracker"),
        detector,
        sensor: settings.chosen("sensor"),
        contact_height_m: settings.number("contact-height"),
        causal: settings.is_on("causal"),
        magnetometer: settings.is_on("magnetometer") && turns_back(settings),
        smooth: settings.is_on("smooth") && !settings.is_on("causal"),
        scalar: settings.chosen("scalar"),
    }
}

/// The equivalent configuration of firmware.
pub(super) fn firmware(options: &Options) -> String {
    let (scalar, number) =
        (Literal::number_type(options.scalar), |value| Literal::number(options.scalar, value));
    let config = format!("Config::<{scalar}>");
    let mut literal =
        Literal::new("kestirim_pedestrian::Config", options.scalar, &config, "Config::default()")
            .number_field("contact_height", options.contact_height_m());
    if options.sensor == SensorClass::Industrial {
        literal = literal
            .import("kestirim_pedestrian::SensorClass")
            .field("sensor", format!("SensorClass::{:?}", options.sensor));
    }
    if options.detector != DetectorKind::Adaptive {
        literal = literal.field("levels", "false".to_owned());
    }
    let detector = match options.detector {
        DetectorKind::Adaptive => None,
        DetectorKind::Magnitude(value) => Some(("Magnitude", value / STANDARD_GRAVITY)),
        DetectorKind::Variance(value) => Some(("MovingVariance", value / STANDARD_GRAVITY.powi(2))),
        DetectorKind::AngularRate(value) => Some(("AngularRateEnergy", value)),
        DetectorKind::Shoe(value) => Some(("FixedShoe", value)),
    };
    let navigator = format!("{:?}", options.tracker);
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

/// Parses `NAME:THRESHOLD`; `None` without a colon. The threshold of `magnitude` is in g, as in the paper; those of the
/// others are in the units of [`DetectorKind`].
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
        Ok(options(&settings).detector)
    }

    #[test]
    fn nothing_set_is_the_default_but_for_the_sensor_which_is_found() {
        let options = options(&Settings::new(table(None)));
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
