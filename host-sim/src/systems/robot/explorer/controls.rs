//! What can be turned, and what it means.

use clap::ValueEnum;

use super::super::options::{Dimensions, TrackerKind};
use super::super::recording::Recording;
use super::super::tuning::Tuning;
use crate::system::ScalarKind;
use crate::explore::{Control, Settings};

/// Farther above or below the anchors no tag is looked for, m.
const HEIGHTS: f64 = 5.0;

/// Everything, standing as the command line would have it.
pub(super) fn all(recording: &Recording) -> Vec<Control> {
    let own = Tuning::default();
    let gate = own.gate_sigmas.unwrap_or_default();
    let [long, short] = own.huber_sigmas.unwrap_or_default();
    let height = recording.anchors.mean_height();
    let heights = [height - HEIGHTS, height + HEIGHTS, 0.05];
    let mut controls = vec![
        Control::choice(
            "tracker",
            "tracker",
            &[
                ("default", "robust and adaptive"),
                ("ekf", "the paper's EKF (eqs 8-17)"),
                ("aekf", "adaptive EKF, safe form"),
                ("aekf-printed", "adaptive EKF as printed (18, 19)"),
                ("nls", "nonlinear least squares of each epoch"),
                ("lsq", "trilateration of each epoch (eqs 3-7)"),
            ],
        ),
        Control::choice("dim", "dimensions", &[("2", "in the plane"), ("3", "in space")]),
        Control::slider("height", "height of the tag in the plane", "m", heights, height),
        Control::switch("room", "the tag stays within the anchors' rectangle", false),
        Control::decades(
            "range_sigma",
            "σ of a range to begin with (Kalman filters)",
            "m",
            [0.01, 1.0],
            own.range_sigma_m,
        ),
        Control::decades(
            "acceleration",
            "density of the acceleration (Kalman filters)",
            "m²/s³",
            [0.001, 10.0],
            own.acceleration_density,
        ),
        Control::switch("gated", "leave out what is beyond the gate (robust)", true),
        Control::slider("gate", "gate (robust)", "σ", [1.0, 15.0, 0.5], gate),
        Control::switch("weakened", "weaken what does not fit, Huber (robust)", true),
        Control::slider(
            "long",
            "Huber's threshold of too long (robust)",
            "σ",
            [0.1, 5.0, 0.1],
            long,
        ),
        Control::slider(
            "short",
            "Huber's threshold of too short (robust)",
            "σ",
            [0.1, 5.0, 0.1],
            short,
        ),
        Control::switch("learns", "learn each anchor's noise (robust)", own.learns),
        Control::decades(
            "decay",
            "how long a velocity lasts (robust)",
            "s",
            [0.2, 20.0],
            own.decay_time_s.unwrap_or_default(),
        ),
        Control::choice(
            "scalar",
            "number type",
            &[("f32", "f32"), ("f64", "f64"), ("fixed", "fixed point, Q12.20")],
        ),
    ];
    if recording.biases.is_some() {
        controls.push(Control::switch("calibrated", "use the anchors' calibration", true));
    }
    controls
}

pub(super) fn tracker(settings: &Settings) -> TrackerKind {
    TrackerKind::from_str(settings.choice("tracker"), false).unwrap_or_default()
}

pub(super) fn dimensions(settings: &Settings) -> Dimensions {
    Dimensions::from_str(settings.choice("dim"), false).unwrap_or_default()
}

pub(super) fn scalar(settings: &Settings) -> ScalarKind {
    ScalarKind::from_str(settings.choice("scalar"), false).unwrap_or(ScalarKind::F32)
}

/// The constants of the trackers as they stand.
pub(super) fn tuning(settings: &Settings) -> Tuning {
    let huber = [settings.number("long"), settings.number("short")];
    Tuning {
        range_sigma_m: settings.number("range_sigma"),
        acceleration_density: settings.number("acceleration"),
        gate_sigmas: settings.is_on("gated").then(|| settings.number("gate")),
        huber_sigmas: settings.is_on("weakened").then_some(huber),
        decay_time_s: Some(settings.number("decay")),
        learns: settings.is_on("learns"),
    }
}
