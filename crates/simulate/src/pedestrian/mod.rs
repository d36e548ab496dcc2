//! Walks that nobody walked: route, gait, and what the sensor makes of them.

pub mod gait;
pub mod kinematics;
pub mod scenario;
pub mod sensor;
