//! The Kalman tracker in single precision.

#![no_std]
#![no_main]

use images::pedestrian::Walk;
use images::replay::run;
use kestirim_pedestrian::Ekf;
use support::image;

image!(run::<Walk<f32, Ekf<f32>>>);
