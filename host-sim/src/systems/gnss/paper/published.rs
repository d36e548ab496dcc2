//! Results published in the paper, each with its table.

use serde::Serialize;

/// Mean errors of a filter in precise point positioning: north, east, up and 3-D (mm).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PppErrors {
    /// The mean of the absolute errors after 24 h.
    pub final_mm: [f64; 4],
    /// The root mean squares over all epochs after the first hour.
    pub rms_mm: [f64; 4],
    /// The time until the error stays below 10 cm for 15 minutes (min); not published for kinematic solutions.
    pub convergence_min: Option<f64>,
}

const fn ppp(final_mm: [f64; 4], rms_mm: [f64; 4], convergence_min: Option<f64>) -> PppErrors {
    PppErrors { final_mm, rms_mm, convergence_min }
}

/// Bahadur and Nohutcu 2020 (robust Kalman filters for precise point positioning, in Turkish), Table 2: static
/// solutions by GKF, RKF, SKF, IKF and UKF, ten stations of the IGS on ten days each.
pub const STATIC: [PppErrors; 5] = [
    ppp([14.9, 27.1, 42.8, 50.9], [38.5, 64.5, 92.3, 116.3], Some(69.36)),
    ppp([6.3, 13.9, 15.7, 24.2], [20.2, 37.9, 50.3, 66.2], Some(53.15)),
    ppp([9.7, 19.3, 21.1, 32.5], [29.9, 50.2, 63.4, 85.9], Some(57.05)),
    ppp([4.6, 9.1, 11.5, 17.4], [9.3, 18.4, 24.6, 32.1], Some(30.46)),
    ppp([4.6, 9.0, 11.4, 17.4], [9.0, 18.1, 24.0, 31.8], Some(30.45)),
];
/// Table 3 of the same paper: kinematic solutions of the same days by IKF and UKF.
pub const KINEMATIC: [PppErrors; 2] = [
    ppp([23.9, 27.8, 34.9, 57.8], [83.8, 96.1, 120.2, 175.2], None),
    ppp([20.3, 23.2, 32.3, 51.6], [51.3, 61.7, 107.1, 133.7], None),
];
