//! Everything of `kestirim-telemetry`, linked.

#![no_std]
#![no_main]

surface::image!(surface::telemetry::run);
