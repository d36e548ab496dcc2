//! Calls everything of `kestirim-integer-ambiguity`.

use kestirim_integer_ambiguity::{Decorrelated, Error, Fix};

use super::values::{any, call_each, keep, number, numbers, slice};

fn ambiguities<const N: usize>() {
    let (floats, entries) = (numbers::<f64, 6>(), numbers::<f64, 8>());
    let entry = |i: usize, j: usize| entries.get(i ^ j).copied().unwrap_or_else(number);
    let decorrelated = any(Decorrelated::<N>::new(slice(&floats), entry));
    let Ok(decorrelated) = decorrelated else { return };
    keep(Decorrelated::len(&decorrelated));
    keep(Decorrelated::is_empty(&decorrelated));
    keep(Decorrelated::success_rate(&decorrelated));
    let nearest: Result<Fix<N>, Error> = any(Decorrelated::nearest(&decorrelated));
    if let Ok(fix) = nearest {
        keep(Fix::ratio(&fix));
    }
}

/// Calls everything in this module.
pub fn run() {
    call_each([ambiguities::<1>, ambiguities::<5>, ambiguities::<12>]);
}
