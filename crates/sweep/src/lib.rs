#![doc = include_str!("../README.md")]

pub mod archive;
mod block;
mod error;
mod job;
mod merge;
mod plan;
mod provenance;
mod shard;
mod shared;
mod summary;
pub mod table;
mod value;
mod work;

pub use block::{Block, Samples};
pub use error::Error;
pub use job::Job;
pub use merge::{Merge, Row};
pub use plan::{Logs, Plan, Study, matching};
pub use provenance::{Input, Program};
pub use shard::Shard;
pub use shared::Shared;
pub use summary::{Summarised, Summary};
pub use value::{Column, Kind, Value};
pub use work::{Head, Work};

/// Bytes in hexadecimal.
pub fn hex(bytes: &[u8]) -> String {
    use std::fmt::Write as _;
    bytes.iter().fold(String::new(), |mut text, byte| {
        // Writing to a `String` cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}
