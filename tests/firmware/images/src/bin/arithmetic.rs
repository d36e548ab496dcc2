//! Computes with numbers at the limits and at random, and prints a digest of the bits of the results.

#![no_std]
#![no_main]

use images::stream::{Record, Stream, open};
use pairs::{Operation, digest_of, operations};
use support::{image, line};

#[path = "../../../../../crates/arithmetic/src/soft/pairs.rs"]
mod pairs;

const OPERATIONS: [Operation; 7] = operations(|a, _| kestirim_arithmetic::sqrt(a));

/// An operation, and the number and the seed of random pairs.
struct Task {
    operation: u32,
    seed: u32,
    count: u32,
}

impl Record for Task {
    const WORDS: usize = 4;

    fn new(_: u64, words: &[[u8; 4]]) -> Option<Self> {
        let [operation, seed, count] = words.as_array()?.map(u32::from_le_bytes);
        Some(Self { operation, seed, count })
    }
}

fn run() {
    let file = open();
    for (_, Task { operation, seed, count }) in Stream::of(&file) {
        if let Some(&(name, operation)) = OPERATIONS.get(operation as usize) {
            line(name, &[digest_of(seed, count, operation).into()]);
        }
    }
}

image!(run);
