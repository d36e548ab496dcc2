//! The thesis' experiments on synthetic flights, compared with its own statements.

pub mod accuracy;
pub mod catching;
pub mod chapter;
pub mod claims;
pub mod experiment;
pub mod published;
pub mod report;
pub mod responses;
