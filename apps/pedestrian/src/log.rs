//! The log: lines gathered to blocks, because a card writes whole blocks whatever one asks for.

use embedded_io::Write;
use heapless::{String, Vec};

use crate::{Counts, razor};

/// Bytes of a card's block.
const BLOCK: usize = 512;
/// Blocks between two updates of the directory: what a cut of the power costs, about a second.
const BLOCKS_A_FLUSH: u32 = 8;

/// A Razor's log in a file.
pub(crate) struct Log<F> {
    file: F,
    block: Vec<u8, BLOCK>,
    blocks: u32,
}

impl<F: Write> Log<F> {
    pub(crate) fn new(file: F) -> Self {
        Self { file, block: Vec::new(), blocks: 0 }
    }

    /// Adds a sample.
    pub(crate) fn add(&mut self, time_us: u64, counts: &Counts) -> Result<(), F::Error> {
        let mut text = String::<{ razor::LONGEST }>::new();
        // Cannot fail: no line is longer.
        let _ = razor::line(&mut text, time_us, counts);
        let bytes = text.as_bytes();
        let free = (BLOCK - self.block.len()).min(bytes.len());
        let (now, later) = bytes.split_at_checked(free).unwrap_or((bytes, &[]));
        let _ = self.block.extend_from_slice(now);
        if !self.block.is_full() {
            return Ok(());
        }
        let written = self.write();
        let _ = self.block.extend_from_slice(later);
        written
    }

    /// Writes what is there, and the directory.
    pub(crate) fn close(&mut self) -> Result<(), F::Error> {
        self.write()?;
        self.file.flush()
    }

    /// Writes what is there; what the file does not take is lost.
    fn write(&mut self) -> Result<(), F::Error> {
        let written = self.file.write_all(&self.block);
        self.block.clear();
        self.blocks = self.blocks.wrapping_add(1);
        written?;
        if self.blocks.is_multiple_of(BLOCKS_A_FLUSH) { self.file.flush() } else { Ok(()) }
    }
}
