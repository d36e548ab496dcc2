//! Measurement models, a file each: physics, source, Jacobian, and the test that a measurement must pass.
//!
//! Each is an [`Observation`](kestirim_kalman::Observation) of the tracker's states: D coordinates (m), D
//! velocities (m/s), perhaps a common bias (m).

mod proportional_range;
mod range;
mod speed;
mod standstill;

pub(crate) use proportional_range::ProportionalRange;
pub(crate) use range::Range;
pub(crate) use speed::Speed;
pub(crate) use standstill::Standstill;

/// Largest NIS of a measurement of the velocity, 3 σ; beyond it the measurement is left out.
const CONTRADICTION: f64 = 9.0;
