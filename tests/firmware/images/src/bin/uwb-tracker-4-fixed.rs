//! A tag in the plane among four anchors, in fixed point.

#![no_std]
#![no_main]

use images::replay::run;
use images::uwb::Plane;
use kestirim_scalar::Q12_20;
use support::image;

image!(run::<Plane<Q12_20, 4>>);
