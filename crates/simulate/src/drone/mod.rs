//! Synthetic users, what a drone measures of them, and where it flies.

pub mod beyond;
pub mod moving_user;
pub mod scenario;
pub mod static_user;
pub mod trajectory;
pub mod trial;
