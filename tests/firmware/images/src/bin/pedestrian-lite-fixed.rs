//! The lite tracker in fixed point.

#![no_std]
#![no_main]

use images::pedestrian::Walk;
use images::replay::run;
use kestirim_pedestrian::Lite;
use kestirim_scalar::Q12_20;
use support::image;

image!(run::<Walk<Q12_20, Lite<Q12_20>>>);
