//! Measurement models, a file each: the physics, its source, its Jacobian, and when it is believed.
//!
//! Each is an [`Observation`](kestirim_kalman::Observation) of the tracker's states: D coordinates (m), D
//! velocities (m/s), perhaps a common bias (m).

mod range;
mod speed;
mod standstill;

pub(crate) use range::Range;
pub(crate) use speed::Speed;
pub(crate) use standstill::Standstill;

/// A measurement of the velocity that contradicts the estimate by more than 3 σ is not believed (NIS).
const CONTRADICTION: f64 = 9.0;
