//! The thesis' experiments on synthetic flights, beside what it says of its own.

pub mod accuracy;
pub mod catching;
pub mod chapter;
pub mod claims;
pub mod experiment;
pub mod published;
pub mod report;
pub mod responses;
