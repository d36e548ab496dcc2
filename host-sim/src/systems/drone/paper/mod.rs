//! The thesis: its published numbers, its experiment, and its part of the report.

pub mod chapter;
pub mod experiment;
pub mod published;
pub mod report;
pub mod sweeps;
