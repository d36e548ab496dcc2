//! Layouts of stored estimators. Raise the version of one whose stored form changes.

use crate::{Lean, PppFilter};
use kestirim_snapshot::layout;

layout! {
    [const N: usize] for PppFilter<N> as "ppp", 7, f64, [N];
    [const N: usize] for PppFilter<N, Lean> as "ppp/lean", 5, f64, [N];
}
