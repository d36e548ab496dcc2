//! What stored estimators are. Raise the version of one that is stored otherwise than before.

use crate::{Lean, PppFilter};
use kestirim_snapshot::layout;

layout! {
    [const N: usize] for PppFilter<N> as "ppp", 4, f64, [N];
    [const N: usize] for PppFilter<N, Lean> as "ppp/lean", 2, f64, [N];
}
