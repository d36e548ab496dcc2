//! Synthetic users, the drone's measurements of them, and its flight paths.

pub mod beyond;
pub mod moving_user;
pub mod scenario;
pub mod static_user;
pub mod trajectory;
pub mod trial;
