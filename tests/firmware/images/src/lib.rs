//! Shared parts of the images: a recorded stream and the loop that replays it through a tracker.
//!
//! An image is a binary of a few lines in `src/bin`: it names a workload and passes it to [`support::image!`].

#![no_std]

pub mod attitude;
pub mod augmented;
pub mod augmented_model;
pub mod design;
pub mod four_ranges;
pub mod observer;
pub mod path_loss;
pub mod pedestrian;
pub mod ppp;
pub mod replay;
pub mod stream;
pub mod uav;
pub mod uwb;
