//! Calls the double precision of `kestirim-arithmetic`.

use kestirim_arithmetic::sqrt_f64;

use super::values::{any, keep};

/// Calls everything in this module.
pub fn run() {
    keep(sqrt_f64(any(2.0)));
}
