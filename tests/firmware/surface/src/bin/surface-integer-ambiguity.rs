//! Links everything of `kestirim-integer-ambiguity`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../integer_ambiguity.rs"]
mod integer_ambiguity;

use surface::values;

surface::image!(integer_ambiguity::run);
