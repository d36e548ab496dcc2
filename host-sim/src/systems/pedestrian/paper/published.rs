//! Results published in the paper, each with its table.

use serde::Serialize;

/// Path lengths of walks at one sampling rate, from Aydın and Erken, *Mühendislik Bilimleri ve Tasarım Dergisi* (JESD),
/// doi:10.21923/jesd.450256.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PathLengths {
    /// The table of the paper.
    pub source: &'static str,
    /// The length of each walk as measured by the paper's tracker (m).
    pub walks_m: [f64; 7],
    /// The printed mean of the absolute relative errors (%).
    pub mean_relative_error_percent: f64,
    /// The printed standard deviation (m); it is that of the path lengths (n − 1), not of the errors.
    pub sigma_m: f64,
}

/// The length of the paper's route through a flat (m).
pub const ROUTE_M: f64 = 12.60;

/// Lines of the log from the paper's Table 1: time in ms, 3 × g, 3 × °/s.
pub const LOG_LINES: [&str; 3] = [
    "1490 -0.06 -0.21 -0.99 2.44 2.90 2.13",
    "1499 -0.05 -0.21 -0.98 3.41 2.35 1.52",
    "1508 -0.04 -0.22 -0.98 2.96 1.68 1.19",
];
/// The position of the walker after 15 s in the paper's Fig. 16: x and y (m); z is about 0.
pub const AFTER_15_S: [f64; 2] = [6.0, 3.0];

/// The seven walks logged at 50 Hz.
pub const FIFTY_HZ: PathLengths = PathLengths {
    source: "Table 3",
    walks_m: [12.53, 13.37, 11.96, 13.12, 13.65, 12.89, 13.44],
    mean_relative_error_percent: 4.74,
    sigma_m: 0.589,
};

/// The seven walks logged at 100 Hz.
pub const HUNDRED_HZ: PathLengths = PathLengths {
    source: "Table 4",
    walks_m: [12.74, 14.35, 12.87, 14.48, 14.63, 14.89, 14.58],
    mean_relative_error_percent: 11.72,
    sigma_m: 0.8852,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::{mean, standard_deviation};

    #[test]
    fn printed_summaries_follow_from_the_printed_walks() {
        for (printed, sigma_digits) in [(FIFTY_HZ, 1e-3), (HUNDRED_HZ, 1e-4)] {
            let errors = printed.walks_m.map(|walk| (walk / ROUTE_M - 1.0).abs() * 100.0);
            assert!((mean(&errors) - printed.mean_relative_error_percent).abs() < 0.005);
            let sigma = standard_deviation(&printed.walks_m);
            assert!((sigma - printed.sigma_m).abs() < sigma_digits / 2.0);
        }
    }
}
