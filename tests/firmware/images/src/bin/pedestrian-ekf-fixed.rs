//! The Kalman tracker in fixed point.

#![no_std]
#![no_main]

use images::pedestrian::Walk;
use images::replay::run;
use kestirim_pedestrian::Ekf;
use kestirim_scalar::Q12_20;
use support::image;

image!(run::<Walk<Q12_20, Ekf<Q12_20>>>);
