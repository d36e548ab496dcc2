//! Computes with numbers at the edges and at random, and tells what the bits of the results amount to.

#![no_std]
#![no_main]

use images::stream::{Record, Stream, open};
use pairs::{OPERATIONS, Pairs, digests, edges};
use support::{image, line};

#[path = "../../../../../crates/arithmetic/src/soft/pairs.rs"]
mod pairs;

/// How many pairs at random, of which seed; of none, all pairs of edges.
struct Task {
    seed: u32,
    count: u32,
}

impl Record for Task {
    const WORDS: usize = 3;

    fn new(_: u64, words: &[[u8; 4]]) -> Option<Self> {
        let [seed, count] = words.as_array()?.map(u32::from_le_bytes);
        Some(Self { seed, count })
    }
}

fn run() {
    let file = open();
    for (_, Task { seed, count }) in Stream::of(&file) {
        let digests = if count == 0 {
            digests(edges().flat_map(|a| edges().map(move |b| (a, b))), kestirim_arithmetic::sqrt)
        } else {
            let mut pairs = Pairs::new(seed);
            digests((0..count).map(|_| pairs.pair()), kestirim_arithmetic::sqrt)
        };
        for (operation, digest) in OPERATIONS.iter().zip(digests) {
            line(operation, &[digest.into()]);
        }
    }
}

image!(run);
