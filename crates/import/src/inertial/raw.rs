//! A sample in the log's own units.

/// One sample: time, specific force and angular rate, in the log's own units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Raw {
    pub(crate) time: f64,
    pub(crate) force: [f64; 3],
    pub(crate) rate: [f64; 3],
}
