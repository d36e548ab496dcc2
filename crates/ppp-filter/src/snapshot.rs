//! Layouts of stored estimators. Raise the version of one whose stored form changes.

use crate::{Lean, PppFilter};
use kestirim_snapshot::layout;

layout! {
    [const N: usize] for PppFilter<N> as "ppp", 6, f64, [N];
    [const N: usize] for PppFilter<N, Lean> as "ppp/lean", 4, f64, [N];
}
