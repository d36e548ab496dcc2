#![doc = include_str!("../README.md")]
#![no_std]

mod drone;
mod gnss;
mod gnss_antenna;
mod gnss_broadcast;
mod gnss_corrections;
mod gnss_products;
mod health;
mod memory;
mod pedestrian;
mod robot;
mod status;
mod uav;
mod uwb;
mod wheels;

pub use drone::*;
pub use gnss::*;
pub use gnss_antenna::*;
pub use gnss_broadcast::*;
pub use gnss_corrections::*;
pub use gnss_products::*;
pub use health::*;
pub use pedestrian::*;
pub use robot::*;
pub use status::*;
pub use uav::*;
pub use uwb::*;
pub use wheels::*;

use core::mem::MaybeUninit;

use kestirim_scalar::Scalar;

/// Converts numbers to C's `float`.
fn floats<T: Scalar, const N: usize>(numbers: &[T; N]) -> [f32; N] {
    numbers.map(T::to_f32)
}

/// Writes numbers as C's `float`. Never inlined, so that the compiler knows that the two places are distinct: otherwise
/// it links `memmove`.
#[inline(never)]
fn write<T: Scalar, const N: usize>(place: &mut MaybeUninit<[f32; N]>, numbers: &[T; N]) {
    place.write(floats(numbers));
}
