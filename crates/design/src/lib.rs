#![doc = include_str!("../README.md")]

mod error;
mod sized;
mod solution;

pub use self::error::Error;
pub use self::sized::{
    MOST_STATES, MOST_WIDE, Observed, discretise, error_covariance, lyapunov, place, riccati,
};
pub use self::solution::Solution;
