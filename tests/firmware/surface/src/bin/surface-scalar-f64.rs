//! The double precision of `kestirim-scalar`, linked.

#![no_std]
#![no_main]

surface::image!(surface::scalar_f64::run);
