//! The paper's adaptive filter in its safe form, in fixed point.

#![no_std]
#![no_main]

use images::four_ranges::Aekf;
use images::replay::run;
use kestirim_scalar::Q12_20;
use support::image;

image!(run::<Aekf<Q12_20>>);
