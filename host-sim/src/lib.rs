//! Feeds the estimators with synthetic and recorded streams and shows what comes out.
//!
//! A sample flows one way: a recorded log or a seeded scenario → the system's estimator → an account of plain data,
//! which a command prints, draws or writes.
//!
//! Everything inside is SI and radians; other units are converted where a file is read.
//! Every system lives in its own folder below [`systems`] and knows nothing of the others; the [`commands`] know
//! no more of one than the face that [`system`] describes.

pub mod commands;
mod error;
pub mod mcap;
mod numbers;
pub mod output;
pub mod report;
pub mod stream;
pub mod system;
pub mod systems;
pub mod table;
pub mod text;

pub use error::Error;
pub use kestirim_figure as figure;
pub use kestirim_replay::metrics;
pub use kestirim_simulate::random;

/// Stack of a thread that estimates: a filter of thousands of particles is moved about a few times before it
/// lies on the heap.
pub const STACK_BYTES: usize = 16 << 20;
