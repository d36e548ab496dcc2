//! What recordings of either kind have to turn.

use kestirim_observer_design::Complex;

use super::super::design::MIDDLE;
use crate::explore::{Control, Settings};

/// Names and labels of the observer's poles.
const POLES: [(&str, &str); 4] = [
    ("pole_1", "observer's pole 1"),
    ("pole_2", "observer's pole 2"),
    ("pole_3", "observer's pole 3"),
    ("pole_4", "observer's pole 4"),
];

/// Poles of the observer, and what the filter takes the noise for.
pub(super) fn estimators() -> Vec<Control> {
    let poles = POLES.into_iter().zip(MIDDLE);
    let mut controls: Vec<_> = poles
        .map(|((name, label), pole)| Control::slider(name, label, "1/s", [-30.0, -0.1, 0.1], pole))
        .collect();
    controls.push(Control::decades("faster", "all poles times", "", [0.1, 10.0], 1.0));
    controls.push(Control::decades(
        "ratio",
        "the filter's Q/R, times that of the noise there is",
        "",
        [1e-6, 1e6],
        1.0,
    ));
    controls
}

/// Which aircraft, the thesis' first.
pub(super) fn plant() -> Control {
    let plants = [("P2", "P2 thesis-like"), ("P1", "P1 Aerosonde"), ("P3", "P3 Navion")];
    Control::choice("plant", "aircraft", &plants)
}

/// Where the sliders put the observer's poles, 1/s.
pub(super) fn poles(settings: &Settings) -> [f64; 4] {
    POLES.map(|(name, _)| settings.number(name) * settings.number("faster"))
}

/// The same as complex numbers.
pub(super) fn complex(poles: [f64; 4]) -> [Complex<f64>; 4] {
    poles.map(|re| Complex { re, im: 0.0 })
}
