//! The common scenario with the filters of other crates, for comparison: the same stream, steps and expected ranges as
//! [`images::four_ranges::Ekf`]. Only the filter is theirs, used as its documentation shows, in the cheapest form that
//! it offers.

#![no_std]

pub mod adskalman;
pub mod kfilter;
pub mod minikalman;
