//! Results published in the paper, each with its table.

use serde::Serialize;

/// Position errors at one point of the office: errors of the mean of 50 measurements (cm).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PositionErrors {
    /// The error of trilateration alone.
    pub unfiltered_cm: f64,
    /// The error of the extended Kalman filter.
    pub ekf_cm: f64,
    /// The error of the adaptive extended Kalman filter.
    pub aekf_cm: f64,
}

const fn errors(unfiltered_cm: f64, ekf_cm: f64, aekf_cm: f64) -> PositionErrors {
    PositionErrors { unfiltered_cm, ekf_cm, aekf_cm }
}

/// Table 1 of the robot's paper (ultra-wideband ranging and an IMU on an ESP32, in Turkish): points P1 to
/// P15.
pub const TABLE_1: [PositionErrors; 15] = [
    errors(11.64, 8.04, 0.46),
    errors(17.37, 11.87, 0.74),
    errors(19.10, 7.55, 4.78),
    errors(16.87, 7.33, 3.20),
    errors(28.10, 10.18, 2.35),
    errors(3.87, 5.71, 4.69),
    errors(11.70, 4.79, 3.16),
    errors(17.91, 3.29, 1.13),
    errors(6.88, 5.49, 2.82),
    errors(11.93, 6.21, 4.27),
    errors(14.93, 4.13, 1.73),
    errors(7.59, 7.09, 3.68),
    errors(13.35, 3.96, 1.46),
    errors(28.62, 8.03, 2.43),
    errors(21.16, 7.61, 0.89),
];

/// The means of Table 1 as published.
pub const TABLE_1_MEAN: PositionErrors = errors(15.40, 6.75, 2.52);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::mean;

    #[test]
    fn the_means_follow_from_the_points() {
        let column = |of: fn(&PositionErrors) -> f64| mean(&TABLE_1.each_ref().map(of));
        assert!((column(|p| p.unfiltered_cm) - TABLE_1_MEAN.unfiltered_cm).abs() < 0.006);
        assert!((column(|p| p.ekf_cm) - TABLE_1_MEAN.ekf_cm).abs() < 0.006);
        assert!((column(|p| p.aekf_cm) - TABLE_1_MEAN.aekf_cm).abs() < 0.006);
    }
}
