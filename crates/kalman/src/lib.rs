#![doc = include_str!("../README.md")]
#![no_std]

mod covariance;
mod error;
mod gaussian;
mod row;

pub use covariance::Covariance;
pub use error::Error;
pub use gaussian::{Gaussian, Innovation};
pub use row::SparseRow;
