//! The double precision of `kestirim-luenberger`, linked.

#![no_std]
#![no_main]

surface::image!(surface::luenberger_f64::run);
