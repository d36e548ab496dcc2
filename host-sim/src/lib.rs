//! Feeds the estimators with synthetic and recorded streams and presents the results.
//!
//! A sample flows one way: a recorded log or a seeded scenario → the system's estimator → an account of plain data,
//! which a command prints, draws or writes.
//!
//! All internal quantities are in SI units and radians; other units are converted where a file is read. Every system
//! lives in its own folder below [`systems`], independent of the others; the [`commands`] know each system only through
//! the interface that [`system`] describes.

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

/// The stack size of a thread that runs estimators, in bytes: a filter of thousands of particles is moved several times
/// on the stack before it is boxed.
pub const STACK_BYTES: usize = 16 << 20;
