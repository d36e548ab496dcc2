//! The aeroplane's filter of 4 states, 2 gusts and 3 biases at 100 Hz in single precision.

#![no_std]
#![no_main]

use images::augmented::run;
use support::image;

image!(run);
