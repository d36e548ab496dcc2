//! The hardware of applications under QEMU, behind the traits of `embedded-hal` 1.0.
//!
//! The machine is `lm3s6965evb`, with a Cortex-M0 or a Cortex-M4F in place of its Cortex-M3. It has what an application
//! needs and QEMU emulates: serial ports ([`Uart`]), and a serial bus with an SD card ([`Spi`], [`CardSelect`]). It has
//! no sensors; these are simulated here at register level, from a [`Recording`] ([`Mpu9250`], [`Bno055`],
//! [`Ms4525do`]).
//!
//! An application that needs more memory uses the machine `mps2-an386` (the feature of that name), of which there is a
//! serial port, polled ([`CmsdkUart`]) or with interrupts ([`CmsdkPort`]).
//!
//! `defmt` writes to the semihosting console. All `unsafe` code of the applications on Arm is in `registers.rs`, in
//! `system.rs`, and in `mps2-an386`, which names that machine's interrupts.

#![no_std]

mod bno055;
mod cmsdk_port;
mod cmsdk_uart;
mod delay;
mod i2c;
mod mpu9250;
mod ms4525do;
mod pin;
mod recording;
mod registers;
mod spi;
mod system;
mod tape;
mod uart;

// The critical-section implementation and the logger are found by their symbols.
use cortex_m as _;
use defmt_semihosting as _;

pub use bno055::Bno055;
pub use cmsdk_port::CmsdkPort;
pub use cmsdk_uart::CmsdkUart;
pub use delay::Delay;
pub use i2c::{NoAcknowledge, Only};
pub use mpu9250::Mpu9250;
pub use ms4525do::Ms4525do;
pub use pin::CardSelect;
pub use recording::Recording;
pub use spi::Spi;
pub use system::{exit, fail};
pub use tape::{Port, Tape};
pub use uart::Uart;
