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

/// The UAV's thesis (Turkish; longitudinal states by a Luenberger observer and a Kalman filter) prints no numbers,
/// but says what its figures show. Table 3.1: steady flight, of α, q, V and θ.
pub const UAV_TRIM: [&str; 4] = ["8°", "0", "40 m/s", "12°"];
/// Sections 4.2.1 and 4.2.2: what is asked of the ranks of [B AB …] and [C; CA; …].
pub const UAV_RANK: &str = "rank 4";
/// Fig. 5.2: when step responses have settled, s.
pub const UAV_SETTLING_S: f64 = 600.0;
/// Figs 5.5 to 5.8, constant inputs: what, and what is said of it.
pub const UAV_CONSTANT_INPUTS: [[&str; 2]; 6] = [
    ["α after 1.5 s, rad (Fig. 5.5)", "about −0.17"],
    ["α after 10 s, rad (Fig. 5.5)", "about −0.17"],
    ["lowest q, when (Fig. 5.6)", "about 0.1 s"],
    ["lowest V, m/s (Fig. 5.7)", "above 35"],
    ["lowest θ, rad (Fig. 5.8)", "0.48"],
    ["θ after 10 s, rad (Fig. 5.8)", "about 0.75"],
];
/// When the noise-free Kalman filter has caught α, q, V and θ, s; V is said to take 1.5 s longer than α and q.
pub const UAV_KALMAN_CAUGHT: ([&str; 4], &str) = (["≈ 5", "≈ 2", "3.5–6.5", "8–9"], "Figs 6.1–6.4");
/// The same of the noise-free Luenberger observer.
pub const UAV_LUENBERGER_CAUGHT: ([&str; 4], &str) =
    (["≈ 1.5", "≈ 2", "invisible", "< 1"], "Figs 6.13–6.17");
/// The same with sine inputs.
pub const UAV_SINE_CAUGHT: ([&str; 4], &str) =
    (["≈ 0.25", "≈ 0.25", "≈ 0.25", "≈ 0.25"], "Fig. 6.25");

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
