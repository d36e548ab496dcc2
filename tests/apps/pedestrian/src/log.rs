//! The log: lines are collected into blocks, because a card always writes whole blocks.

use embedded_io::Write;
use heapless::{String, Vec};

use crate::{Counts, razor};

/// The size of a card's block, bytes.
const BLOCK: usize = 512;
/// The number of blocks between two updates of the directory: a power cut loses that much, about a second.
const BLOCKS_A_FLUSH: u32 = 8;

/// A log in the Razor's format, in a file.
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

    /// Writes the remaining bytes and updates the directory.
    pub(crate) fn close(&mut self) -> Result<(), F::Error> {
        self.write()?;
        self.file.flush()
    }

    /// Writes the collected bytes; those that the file does not take are lost.
    fn write(&mut self) -> Result<(), F::Error> {
        let written = self.file.write_all(&self.block);
        self.block.clear();
        self.blocks = self.blocks.wrapping_add(1);
        written?;
        if self.blocks.is_multiple_of(BLOCKS_A_FLUSH) { self.file.flush() } else { Ok(()) }
    }
}
