//! Elementary functions in double precision: those of `libm`, each within one unit in the last
//! place.

pub(super) use libm::{atan2, exp, hypot, log as ln, sincos as sin_cos, sqrt};
