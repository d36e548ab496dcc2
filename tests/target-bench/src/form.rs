//! The short form of the tests, which CI runs.

use std::env;

/// Set to 1, what takes long is tested in its short form: CI has half an hour.
pub(crate) const SHORT: &str = "KESTIRIM_SHORT";

/// Whether only what CI has time for is asked for (`KESTIRIM_SHORT=1`).
pub fn is_short() -> bool {
    env::var(SHORT).is_ok_and(|value| value == "1")
}
