//! Arithmetic on emulated boards equals the host's bit for bit: sums, differences, products, quotients, roots,
//! comparisons and conversions of `f32`, by whatever routines the images link.

use std::thread;

use anyhow::{Result, ensure};
use pairs::{Operation, digest_of, operations};
use target_bench::{CORTEX_M0, CORTEX_M4F, Images, Profile, RV32IMC, Target};

#[path = "../../../crates/arithmetic/src/soft/pairs.rs"]
mod pairs;

const OPERATIONS: [Operation; 7] = operations(|a, _| a.sqrt());

/// Compares the image's results of these operations (by their indices in [`OPERATIONS`]) with the expected ones.
fn compare(images: &Images, which: &[u32], seed: u32, count: u32) -> Result<()> {
    let record = |&operation| [0, operation, seed, count].map(u32::to_le_bytes).concat();
    let stream: Vec<u8> = which.iter().flat_map(record).collect();
    let told = images.run("arithmetic", &stream)?;
    for &operation in which {
        let (name, operation) = OPERATIONS[operation as usize];
        let expected = digest_of(seed, count, operation);
        ensure!(
            told.numbers(name)? == [i64::from(expected)],
            "{name} on {}: {count} pairs of seed {seed}",
            images.target.triple
        );
    }
    Ok(())
}

fn edges_and_some_at_random(target: &'static Target) -> Result<()> {
    let Some(images) = Images::of(target, Profile::Speed)? else { return Ok(()) };
    let all = [0, 1, 2, 3, 4, 5, 6];
    compare(&images, &all, 0, 0)?;
    compare(&images, &all, 1, 1_000_000)
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

/// Run with `cargo test --release -p kestirim-tests --test all arithmetic_on_target:: -- --ignored`.
#[test]
#[ignore = "takes a quarter of an hour"]
fn a_thousand_million_sums_and_products_on_a_cortex_m0() -> Result<()> {
    let Some(images) = &Images::of(&CORTEX_M0, Profile::Speed)? else { return Ok(()) };
    let processors = u32::try_from(thread::available_parallelism()?.get())?;
    let mut parts = (0..processors).map(|first| {
        move || {
            let mut seeds = (first..100).step_by(processors as usize);
            seeds.try_for_each(|seed| compare(images, &[0, 2], seed, 10_000_000))
        }
    });
    thread::scope(|scope| {
        let running: Vec<_> = parts.by_ref().map(|part| scope.spawn(part)).collect();
        running.into_iter().try_for_each(|part| part.join().expect("no part panics"))
    })
}
