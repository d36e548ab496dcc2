//! The paper: what it publishes, its experiment, and its part of the report.

pub mod chapter;
pub mod experiment;
pub mod published;
