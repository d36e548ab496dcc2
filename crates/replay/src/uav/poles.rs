//! Poles of observers.

use kestirim_observer_design::Complex;

/// Poles of an observer, 1/s.
pub type Poles = [Complex<f64>; 4];

/// The slow set of poles of the experiment, 1/s; the card states the time to converge that they lead to.
pub const SLOW: Poles = real([-2.0, -1.5, -8.0, -3.5]);
/// Poles that lie close together, 1/s.
pub const MIDDLE: Poles = real([-3.0, -3.5, -4.0, -4.5]);
/// Poles that lead to the thesis' quarter of a second, 1/s.
pub const FAST: Poles = real([-12.0, -14.0, -16.0, -18.0]);

/// Poles without imaginary parts.
const fn real([a, b, c, d]: [f64; 4]) -> Poles {
    [
        Complex { re: a, im: 0.0 },
        Complex { re: b, im: 0.0 },
        Complex { re: c, im: 0.0 },
        Complex { re: d, im: 0.0 },
    ]
}

/// Poles that are `factor` times as fast.
pub fn faster(poles: Poles, factor: f64) -> Poles {
    poles.map(|Complex { re, im }| Complex { re: re * factor, im: im * factor })
}

/// Converts poles in 1/s to poles of discrete time at an interval (s).
pub fn discrete(poles: Poles, interval: f64) -> [Complex<f64>; 4] {
    poles.map(|pole| {
        let size = (pole.re * interval).exp();
        let (sin, cos) = (pole.im * interval).sin_cos();
        Complex { re: size * cos, im: size * sin }
    })
}
