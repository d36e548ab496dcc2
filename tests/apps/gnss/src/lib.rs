//! A carrier-phase receiver that determines its position, as an example application: a u-blox module provides
//! observations on L1 and L2 (UBX-RXM-RAWX), a filter estimates the position, and telemetry frames report it to a host.
//! Orbits and clocks come from a [`Source`]:
//!
//! - [`Products`]: a modem delivers lines of precise orbits and clocks as services publish them (SP3 and RINEX clock
//!   files): centimetres.
//! - [`Broadcasts`]: the satellites themselves, whose messages the module passes on (UBX-RXM-SFRBX): metres, without
//!   further hardware.
//! - [`Corrections`]: the same, corrected by a service whose frames a modem delivers (SSR in RTCM 3): after half an hour
//!   as good as the service, decimetres or less.
//!
//! Ports are accessed through `embedded-io`. [`App::poll`] is the body of the loop; [`site`] is the part to adapt.
#![no_std]

mod app;
mod broadcasts;
mod calendar;
mod corrections;
mod error;
mod frames;
mod lines;
mod observations;
mod products;
pub mod site;
mod source;

pub use app::{App, Epoch, STATES, Unused, VISIBLE};
pub use broadcasts::Broadcasts;
pub use corrections::Corrections;
pub use error::Error;
pub use products::Products;
pub use source::{Source, Unusable};
