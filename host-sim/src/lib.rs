//! Feeds the estimators with synthetic and recorded streams and shows what comes out.
//!
//! A sample flows one way: a recorded [log](systems::pedestrian::log) or a seeded
//! [scenario](systems::pedestrian::scenario) → the system's estimator → a report of plain data, which
//! [`output::show`] prints as a table or as one JSON object.
//!
//! Everything inside is SI and radians; other units are converted where a file is read.
//! Every system lives in its own folder below [`systems`] and knows nothing of the others.

pub mod cli;
pub mod design;
mod error;
pub mod explore;
pub mod figure;
pub mod live;
pub mod mcap;
pub mod metrics;
pub mod output;
pub mod outputs;
pub mod published;
pub mod random;
pub mod report;
pub mod serve;
pub mod stream;
pub mod systems;
pub mod table;
pub mod text;

pub use error::Error;

/// Stack of a thread that estimates: a filter of thousands of particles is moved about a few times before it
/// lies on the heap.
pub const STACK_BYTES: usize = 16 << 20;
