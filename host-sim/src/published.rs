//! What the papers report, as printed, with the table it stands in.

use serde::Serialize;

/// Walked path lengths of one sampling rate, from Aydın and Erken, *Mühendislik Bilimleri ve
/// Tasarım Dergisi* (JESD), doi:10.21923/jesd.450256.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PathLengths {
    /// Table of the paper.
    pub source: &'static str,
    /// Length of each walk as the paper's tracker measured it, m.
    pub walks_m: [f64; 7],
    /// Printed mean of the absolute relative errors, %.
    pub mean_relative_error_percent: f64,
    /// Printed standard deviation, m; it is that of the walked lengths (n − 1), not of the errors.
    pub sigma_m: f64,
}

/// Length of the paper's route through a flat, m.
pub const PEDESTRIAN_ROUTE_M: f64 = 12.60;

/// Seven walks logged at 50 Hz.
pub const PEDESTRIAN_50_HZ: PathLengths = PathLengths {
    source: "Table 3",
    walks_m: [12.53, 13.37, 11.96, 13.12, 13.65, 12.89, 13.44],
    mean_relative_error_percent: 4.74,
    sigma_m: 0.589,
};

/// Seven walks logged at 100 Hz.
pub const PEDESTRIAN_100_HZ: PathLengths = PathLengths {
    source: "Table 4",
    walks_m: [12.74, 14.35, 12.87, 14.48, 14.63, 14.89, 14.58],
    mean_relative_error_percent: 11.72,
    sigma_m: 0.8852,
};

/// Position errors at one point of the robot's office, cm: the error of the mean of 50 measurements.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PositionErrors {
    /// Trilateration alone.
    pub unfiltered_cm: f64,
    /// Extended Kalman filter.
    pub ekf_cm: f64,
    /// Adaptive extended Kalman filter.
    pub aekf_cm: f64,
}

const fn errors(unfiltered_cm: f64, ekf_cm: f64, aekf_cm: f64) -> PositionErrors {
    PositionErrors { unfiltered_cm, ekf_cm, aekf_cm }
}

/// Table 1 of the robot's paper (ultra-wideband ranging and an IMU on an ESP32, in Turkish): points P1 to
/// P15.
pub const ROBOT_TABLE_1: [PositionErrors; 15] = [
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

/// The table's means as printed.
pub const ROBOT_TABLE_1_MEAN: PositionErrors = errors(15.40, 6.75, 2.52);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::{mean, standard_deviation};

    #[test]
    fn printed_summaries_follow_from_the_printed_walks() {
        for (printed, sigma_digits) in [(PEDESTRIAN_50_HZ, 1e-3), (PEDESTRIAN_100_HZ, 1e-4)] {
            let errors =
                printed.walks_m.map(|walk| (walk / PEDESTRIAN_ROUTE_M - 1.0).abs() * 100.0);
            assert!((mean(&errors) - printed.mean_relative_error_percent).abs() < 0.005);
            let sigma = standard_deviation(&printed.walks_m);
            assert!((sigma - printed.sigma_m).abs() < sigma_digits / 2.0);
        }
    }

    #[test]
    fn the_robots_means_follow_from_its_points() {
        let column = |of: fn(&PositionErrors) -> f64| mean(&ROBOT_TABLE_1.each_ref().map(of));
        assert!((column(|p| p.unfiltered_cm) - ROBOT_TABLE_1_MEAN.unfiltered_cm).abs() < 0.006);
        assert!((column(|p| p.ekf_cm) - ROBOT_TABLE_1_MEAN.ekf_cm).abs() < 0.006);
        assert!((column(|p| p.aekf_cm) - ROBOT_TABLE_1_MEAN.aekf_cm).abs() < 0.006);
    }
}
