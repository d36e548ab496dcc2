//! GNSS receivers at a fixed or moving place: files of observations and of the services that describe the
//! satellites.

pub mod experiment;
pub mod files;
pub mod products;
pub mod report;
pub mod sky;
