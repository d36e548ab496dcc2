//! The recorded streams that images read: made anew, the same every time.
//! `tests/firmware/images/src/stream.rs` is their other end.

mod common;
mod flight;
mod inertial;
mod path_loss;
mod ranges;

pub use common::{ANCHORS, Common};
pub use flight::{Flight, fly};
pub use inertial::{Sample, walk};
pub use path_loss::{Records, circle};
pub use ranges::{PLACES, Ranges, ellipse};

/// A record begins with the time since the one before, µs; everything is little-endian.
fn record(elapsed_us: u32, words: impl IntoIterator<Item = [u8; 4]>) -> impl Iterator<Item = u8> {
    elapsed_us.to_le_bytes().into_iter().chain(words.into_iter().flatten())
}

/// The words of an array of single-precision numbers.
fn words<const N: usize>(numbers: &[f32; N]) -> [[u8; 4]; N] {
    numbers.map(f32::to_le_bytes)
}

/// A stream as an image reads it.
pub trait Encode {
    /// The bytes.
    fn encode(&self) -> Vec<u8>;
}
