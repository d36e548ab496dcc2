//! Calls everything of `kestirim-arithmetic`.

use kestirim_arithmetic::sqrt;
use kestirim_arithmetic::vectors::{Kernel, Vectors};

use super::values::{any, call_each, keep};

fn roots() {
    keep(sqrt(any(2.0)));
}

/// Arbitrary work to be run on vectors.
struct Work;

impl Kernel for Work {
    type Output = f32;

    fn run(self) -> f32 {
        any(1.0)
    }
}

fn vectors() {
    keep(Vectors::all().count());
    keep(Vectors::run(Vectors::widest(), Work));
    keep(Kernel::run(Work));
}

/// Calls everything in this module.
pub fn run() {
    call_each([roots, vectors]);
}
