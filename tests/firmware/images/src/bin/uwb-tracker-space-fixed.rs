//! A tag in space among eight anchors, in fixed point.

#![no_std]
#![no_main]

use images::replay::run;
use images::uwb::Space;
use kestirim_scalar::Q12_20;
use support::image;

image!(run::<Space<Q12_20, 8>>);
