//! Everything of `kestirim-telemetry`, linked.

#![no_std]
#![no_main]

#[path = "../telemetry.rs"]
mod telemetry;

use surface::values;

surface::image!(telemetry::run);
