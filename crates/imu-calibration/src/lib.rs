#![doc = include_str!("../README.md")]
#![no_std]

mod accelerometer;
mod calibration;
mod error;
mod gyroscope;
mod magnetometer;
mod matrix;
mod normal;
mod pose;
mod turn;

pub use accelerometer::{AccelerometerFit, AccelerometerModel};
pub use calibration::{Calibration, Triad};
pub use error::Error;
pub use gyroscope::{Gyroscope, GyroscopeFit, GyroscopeModel};
pub use magnetometer::{Magnetometer, MagnetometerFit};
pub use pose::{GyroscopeBias, Pose, Poses, Side};
pub use turn::Turn;
