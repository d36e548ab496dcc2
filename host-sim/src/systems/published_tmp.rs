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

/// Its Table 1: lines of the log, time in ms, 3 × g, 3 × °/s.
pub const PEDESTRIAN_LOG_LINES: [&str; 3] = [
    "1490 -0.06 -0.21 -0.99 2.44 2.90 2.13",
    "1499 -0.05 -0.21 -0.98 3.41 2.35 1.52",
    "1508 -0.04 -0.22 -0.98 2.96 1.68 1.19",
];
/// Where Fig. 16 shows the walker after 15 s: x and y, m; z is about 0.
pub const PEDESTRIAN_AFTER_15_S: [f64; 2] = [6.0, 3.0];

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

/// Mean errors of the drone's thesis (Turkish; a drone base station finds a ground user by a particle filter), m,
/// 100 trials each. Table 3.2: L = 1000, T = 12, h = 500 m, circles of 2000 m divided by 2 to 8.
pub const DRONE_RADIUS: [f64; 7] = [165.0, 133.0, 159.0, 183.0, 242.0, 261.0, 336.0];
/// Table 3.2: L = 1000, T = 12, r = 2000/3 m, h = 200 to 1400 m.
pub const DRONE_HEIGHT: [f64; 7] = [363.0, 197.0, 126.0, 105.0, 103.0, 102.0, 110.0];
/// Table 3.2: h = 800 m, T = 12, r = 2000/3 m, L = 100, 500, … 3000.
pub const DRONE_PARTICLES: [f64; 7] = [139.0, 96.0, 105.0, 97.0, 113.0, 96.0, 109.0];
/// Fig. 3.2, mean errors for T = 10 to 40: multinomial, residual, stratified, systematic.
pub const DRONE_RESAMPLERS_MEAN: [[f64; 7]; 4] = [
    [106.0, 97.0, 88.0, 67.0, 68.0, 60.0, 56.0],
    [128.0, 97.0, 77.0, 68.0, 68.0, 60.0, 61.0],
    [106.0, 98.0, 88.0, 68.0, 67.0, 60.0, 55.0],
    [118.0, 98.0, 80.0, 68.0, 63.0, 55.0, 63.0],
];
/// Fig. 3.3, the largest of the same 100 errors each.
pub const DRONE_RESAMPLERS_MAXIMUM: [[f64; 7]; 4] = [
    [450.0, 395.0, 285.0, 213.0, 196.0, 190.0, 224.0],
    [455.0, 445.0, 234.0, 213.0, 212.0, 202.0, 205.0],
    [461.0, 397.0, 389.0, 210.0, 187.0, 232.0, 174.0],
    [445.0, 331.0, 232.0, 268.0, 206.0, 164.0, 203.0],
];
/// Fig. 3.4, energy of grid and circle for T = 4, 9, 16, 25, J.
pub const DRONE_ENERGY: [[f64; 4]; 2] =
    [[329e3, 597e3, 860e3, 1130e3], [312e3, 426e3, 496e3, 564e3]];
/// Fig. 3.5, mean errors of grid and circle for the same.
pub const DRONE_TRAJECTORIES: [[f64; 4]; 2] =
    [[234.0, 79.0, 49.0, 39.0], [222.0, 76.0, 68.0, 44.0]];
/// T = 16 and the same energy: circle and small grid.
pub const DRONE_EQUAL_ENERGY: [f64; 2] = [67.9, 84.0];

/// Mean errors of precise point positioning by one filter: north, east, up and in three dimensions, mm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PppErrors {
    /// Mean of the absolute errors after 24 h.
    pub final_mm: [f64; 4],
    /// Root mean squares over all epochs after the first hour.
    pub rms_mm: [f64; 4],
    /// Time until the error stays below 10 cm for 15 minutes; not printed for kinematic solutions.
    pub convergence_min: Option<f64>,
}

const fn ppp(final_mm: [f64; 4], rms_mm: [f64; 4], convergence_min: Option<f64>) -> PppErrors {
    PppErrors { final_mm, rms_mm, convergence_min }
}

/// Bahadur and Nohutcu 2020 (robust Kalman filters for precise point positioning, in Turkish), Table 2: static
/// solutions by GKF, RKF, SKF, IKF and UKF, ten stations of the IGS on ten days each.
pub const GNSS_STATIC: [PppErrors; 5] = [
    ppp([14.9, 27.1, 42.8, 50.9], [38.5, 64.5, 92.3, 116.3], Some(69.36)),
    ppp([6.3, 13.9, 15.7, 24.2], [20.2, 37.9, 50.3, 66.2], Some(53.15)),
    ppp([9.7, 19.3, 21.1, 32.5], [29.9, 50.2, 63.4, 85.9], Some(57.05)),
    ppp([4.6, 9.1, 11.5, 17.4], [9.3, 18.4, 24.6, 32.1], Some(30.46)),
    ppp([4.6, 9.0, 11.4, 17.4], [9.0, 18.1, 24.0, 31.8], Some(30.45)),
];
/// Table 3: kinematic solutions of the same days by IKF and UKF.
pub const GNSS_KINEMATIC: [PppErrors; 2] = [
    ppp([23.9, 27.8, 34.9, 57.8], [83.8, 96.1, 120.2, 175.2], None),
    ppp([20.3, 23.2, 32.3, 51.6], [51.3, 61.7, 107.1, 133.7], None),
];

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
