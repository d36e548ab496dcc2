//! The input streams of the images: generated anew, identical every time. `tests/firmware/images/src/stream.rs` reads
//! them.

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

/// A record of a stream: the time since the record before, µs, and words, all little-endian.
fn record(elapsed_us: u32, words: impl IntoIterator<Item = [u8; 4]>) -> impl Iterator<Item = u8> {
    elapsed_us.to_le_bytes().into_iter().chain(words.into_iter().flatten())
}

/// The words of an array of single-precision numbers.
fn words<const N: usize>(numbers: &[f32; N]) -> [[u8; 4]; N] {
    numbers.map(f32::to_le_bytes)
}

/// A stream as an image reads it.
pub trait Encode {
    /// The bytes of the stream.
    fn encode(&self) -> Vec<u8>;
}
