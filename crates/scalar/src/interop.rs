//! Conversions to and from the types of the `fixed` crate with the same number of fractional bits. The bits
//! are the same, so nothing is rounded.

use crate::Fixed;
use fixed::FixedI32;
use fixed::types::extra::{U8, U16, U20, U24, U28, U30};

macro_rules! impl_conversions {
    ($($frac:literal $unsigned:ident),*) => {$(
        impl From<FixedI32<$unsigned>> for Fixed<$frac> {
            fn from(value: FixedI32<$unsigned>) -> Self {
                Self::from_bits(value.to_bits())
            }
        }
        impl From<Fixed<$frac>> for FixedI32<$unsigned> {
            fn from(value: Fixed<$frac>) -> Self {
                Self::from_bits(value.to_bits())
            }
        }
    )*};
}
impl_conversions!(8 U8, 16 U16, 20 U20, 24 U24, 28 U28, 30 U30);
