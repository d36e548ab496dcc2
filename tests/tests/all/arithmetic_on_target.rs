//! Arithmetic on emulated boards gives the host's bits: sums, differences, products, quotients, roots, comparisons and
//! conversions of `f32`, by whatever routines the images link.

use std::thread;

use anyhow::{Result, ensure};
use pairs::{OPERATIONS, Pairs, digests, edges};
use target_bench::{CORTEX_M0, CORTEX_M4F, Images, Profile, RV32IMC, Target};

#[path = "../../../crates/arithmetic/src/soft/pairs.rs"]
mod pairs;

/// A record of the image's stream: how many pairs at random, of which seed. Of none, all pairs of edges.
fn task(seed: u32, count: u32) -> Vec<u8> {
    [0, seed, count].into_iter().flat_map(u32::to_le_bytes).collect()
}

fn expected(seed: u32, count: u32) -> [u32; OPERATIONS.len()] {
    if count == 0 {
        return digests(edges().flat_map(|a| edges().map(move |b| (a, b))), f32::sqrt);
    }
    let mut pairs = Pairs::new(seed);
    digests((0..count).map(|_| pairs.pair()), f32::sqrt)
}

fn compare(images: &Images, seed: u32, count: u32) -> Result<()> {
    let told = images.run("arithmetic", &task(seed, count))?;
    for (operation, digest) in OPERATIONS.iter().zip(expected(seed, count)) {
        ensure!(
            told.numbers(operation)? == [i64::from(digest)],
            "{operation} on {}: {count} pairs of seed {seed}",
            images.target.triple
        );
    }
    Ok(())
}

fn edges_and_some_at_random(target: &'static Target) -> Result<()> {
    let Some(images) = Images::of(target, Profile::Speed)? else { return Ok(()) };
    compare(&images, 0, 0)?;
    compare(&images, 1, 1_000_000)
}

#[test]
fn cortex_m0() -> Result<()> {
    edges_and_some_at_random(&CORTEX_M0)
}

#[test]
fn cortex_m4f() -> Result<()> {
    edges_and_some_at_random(&CORTEX_M4F)
}

#[test]
fn rv32imc() -> Result<()> {
    edges_and_some_at_random(&RV32IMC)
}

/// `cargo test --release -p kestirim-tests --test all arithmetic_on_target:: -- --ignored`
#[test]
#[ignore = "takes more than half an hour"]
fn a_thousand_million_pairs_on_a_cortex_m0() -> Result<()> {
    let Some(images) = &Images::of(&CORTEX_M0, Profile::Speed)? else { return Ok(()) };
    let processors = thread::available_parallelism()?.get() as u32;
    let part = |first| {
        move || {
            (first..100)
                .step_by(processors as usize)
                .try_for_each(|k| compare(images, 1000 + k, 10_000_000))
        }
    };
    thread::scope(|scope| {
        let parts: Vec<_> = (0..processors).map(|first| scope.spawn(part(first))).collect();
        parts.into_iter().try_for_each(|part| part.join().expect("no part panics"))
    })
}
