//! The attitude reference, in fixed point.

#![no_std]
#![no_main]

use images::attitude::Reference;
use images::replay::run;
use kestirim_scalar::Q12_20;
use support::image;

image!(run::<Reference<Q12_20>>);
