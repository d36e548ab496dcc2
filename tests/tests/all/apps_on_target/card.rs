//! SD cards, written and read by another implementation of FAT than the application's.

use std::io::{Cursor, Read};

use anyhow::Result;
use fatfs::{FileSystem, FormatVolumeOptions, FsOptions, format_volume};

const BLOCK: usize = 512;
/// The number of blocks of a card, a power of two as the emulator requires.
const BLOCKS: usize = 1 << 15;
/// The first block of the only partition.
const START: usize = 2048;

/// A card with one empty FAT16 partition.
pub(crate) fn blank() -> Result<Vec<u8>> {
    let mut card = vec![0; BLOCKS * BLOCK];
    let (table, partition) = card.split_at_mut(START * BLOCK);
    table[446 + 4] = 0x0E;
    table[446 + 8..][..4].copy_from_slice(&(START as u32).to_le_bytes());
    table[446 + 12..][..4].copy_from_slice(&((BLOCKS - START) as u32).to_le_bytes());
    table[510..512].copy_from_slice(&[0x55, 0xAA]);
    format_volume(Cursor::new(partition), FormatVolumeOptions::new())?;
    Ok(card)
}

/// The contents of a file in the root directory of the partition.
pub(crate) fn file(card: &mut [u8], name: &str) -> Result<Vec<u8>> {
    let partition = Cursor::new(&mut card[START * BLOCK..]);
    let volume = FileSystem::new(partition, FsOptions::new())?;
    let mut bytes = Vec::new();
    volume.root_dir().open_file(name)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}
