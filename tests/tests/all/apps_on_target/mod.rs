//! Full-size applications on emulated boards: sensors behind their drivers, telemetry over a serial port, a log on an
//! SD card, `defmt` on the console. The data that arrive at the host equal what the host computes itself.
//!
//! On a machine without the tools these tests print SKIPPED and pass; with
//! `KESTIRIM_REQUIRE_TARGETS=1` they fail instead. With `--nocapture` they print sizes.

mod card;
mod contrib;
mod drone;
mod esp32c3;
mod foot_node;
mod gnss;
mod gnss_stream;
mod image;
mod pedestrian;
mod robot;
mod telemetry;
mod uav;
