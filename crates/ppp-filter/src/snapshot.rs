//! What stored estimators are. Raise the version of one that is stored otherwise than before.

use crate::{Lean, PppFilter};
use kestirim_snapshot::layout;

layout! {
    [const N: usize] for PppFilter<N> as "ppp", 5, f64, [N];
    [const N: usize] for PppFilter<N, Lean> as "ppp/lean", 3, f64, [N];
}
