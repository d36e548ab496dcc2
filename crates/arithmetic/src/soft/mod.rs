//! Single precision in integers, for processors without a floating-point unit.

#[cfg(all(feature = "soft-float", armv6m))]
mod armv6m;
mod every_case;
#[cfg(test)]
#[allow(dead_code)] // Its operations are used by the emulated image.
mod pairs;
mod root;
#[cfg(test)]
mod tests;

#[cfg(not(test))]
pub(crate) use root::sqrt;
