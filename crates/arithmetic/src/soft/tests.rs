//! The integer routines compared with the processor that runs the tests.

use super::every_case::{add, divide, multiply};
use super::pairs::{Pairs, edges};
use super::root::sqrt;

fn same(ours: u32, theirs: f32) -> bool {
    ours == theirs.to_bits() || theirs.is_nan() && f32::from_bits(ours).is_nan()
}

fn check(a: u32, b: u32) {
    let (x, y) = (f32::from_bits(a), f32::from_bits(b));
    assert!(same(add(a, b), x + y), "{x:e} + {y:e} ({a:08x}, {b:08x})");
    assert!(same(multiply(a, b), x * y), "{x:e} · {y:e} ({a:08x}, {b:08x})");
    assert!(same(divide(a, b), x / y), "{x:e} / {y:e} ({a:08x}, {b:08x})");
}

fn check_root(bits: u32) {
    let x = f32::from_bits(bits);
    assert!(same(sqrt(x).to_bits(), x.sqrt()), "√{x:e}");
}

/// All fractions with exponents of both parities, on which alone the root depends, and other numbers, also subnormal
/// ones.
#[test]
fn roots_are_the_processors() {
    (0x3f80_0000..0x4080_0000).chain((0..u32::MAX).step_by(997)).for_each(check_root);
}

#[test]
fn all_pairs_of_edges_give_the_processors_bits() {
    for a in edges() {
        for b in edges() {
            check(a, b);
        }
    }
}

/// The estimate of 1/n depends only on the upper 15 bits of n: each of them with the largest and the smallest n.
#[test]
fn every_estimate_of_a_reciprocal_is_good_enough() {
    for n in (0x3f80_0000..0x4000_0000).step_by(256).flat_map(|n| [n, n + 255]) {
        for m in (0x3f80_0000..0x4000_0000).step_by(0x7_fff1).flat_map(|m| [m, m + 255]) {
            let (x, y) = (f32::from_bits(m), f32::from_bits(n));
            assert!(same(divide(m, n), x / y), "{x:e} / {y:e}");
        }
    }
}

#[test]
fn pairs_at_random_give_the_processors_bits() {
    let mut pairs = Pairs::new(1);
    for _ in 0..10_000_000 {
        let (a, b) = pairs.pair();
        check(a, b);
    }
}

/// Run by `cargo test --release -p kestirim-arithmetic -- --ignored`.
#[test]
#[ignore = "takes a minute"]
fn a_thousand_million_pairs_give_the_processors_bits() {
    let mut pairs = Pairs::new(2);
    for _ in 0..1_000_000_000 {
        let (a, b) = pairs.pair();
        check(a, b);
    }
}
