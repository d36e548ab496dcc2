//! The common base of the images on a Cortex-M0, a Cortex-M4F and an RV32IMC:
//!
//! - [`image!`] turns a function into a bootable image that ends QEMU when it returns;
//! - [`Meter`] measures steps: instructions by class of step, and peak stack;
//! - [`line`] prints `key=value` for the host;
//! - [`known`] is code of known cost, to check the meter with.
//!
//! The only `unsafe` code of the images is here, where the hardware requires it. Nothing here can panic or formats with
//! `core::fmt`, so that panic symbols in an image are the workload's own.

#![no_std]

mod counter;
mod image;
pub mod known;
mod line;
mod meter;
mod stack;
mod statistics;

#[cfg(target_arch = "arm")]
use cortex_m_rt as _;
#[cfg(target_arch = "riscv32")]
use riscv_rt as _;

pub use image::{exit, fail};
pub use line::{line, line_of_text};
pub use meter::{Class, Meter};
