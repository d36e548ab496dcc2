//! Synthetic walks: route, gait, and the sensor's measurements.

pub mod gait;
pub mod kinematics;
pub mod scenario;
pub mod sensor;
