//! Links everything of `kestirim-snapshot`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../snapshot.rs"]
mod snapshot;

use surface::values;

surface::image!(snapshot::run);
