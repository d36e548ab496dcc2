//! The short form of the tests, which CI runs.

use std::env;

/// The environment variable that selects the short form of slow tests if it is 1: CI has half an hour.
pub(crate) const SHORT: &str = "KESTIRIM_SHORT";

/// Whether only the short form is requested, for which CI has time (`KESTIRIM_SHORT=1`).
pub fn is_short() -> bool {
    env::var(SHORT).is_ok_and(|value| value == "1")
}
