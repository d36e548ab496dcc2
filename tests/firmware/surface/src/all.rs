//! All modules together, for the host: for a target each is a program.

pub mod adaptive_kalman;
pub mod air_to_ground;
pub mod arithmetic;
pub mod attitude;
pub mod gnss_ppp;
pub mod health;
pub mod imu_calibration;
pub mod integer_ambiguity;
pub mod kalman;
pub mod luenberger;
pub mod luenberger_f64;
pub mod observer_design;
pub mod particle_filter;
pub mod pedestrian;
pub mod ppp_filter;
pub mod robust_kalman;
pub mod scalar;
pub mod scalar_f64;
pub mod snapshot;
pub mod telemetry;
pub mod uav_estimator;
pub mod uav_longitudinal;
pub mod user_locator;
pub mod uwb_ranging;
pub mod uwb_tracker;
pub mod values;
