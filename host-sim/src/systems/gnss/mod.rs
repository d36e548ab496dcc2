//! GNSS receivers at a fixed or moving place.
//!
//! `sky` makes observations, and `experiment` repeats the paper's tables on them.
//! `kestirim-gnss-files` reads the files, and `model` gives what they hold the types of the observation model;
//! `products` and `recording` put together what a filter needs. `follow` feeds one and counts what becomes of the observations, `accuracy` compares with the
//! truth; `session` runs one filter or all for a [replay](replay::Replay) and for the `explorer`. `chapter` is the
//! system's part of the report; `figures` and `streams` show what a filter made of a recording.
//!
//! Times are seconds since the midnight before the first epoch, positions those of the marker, ECEF.

pub mod accounts;
pub mod accuracy;
pub mod chapter;
pub mod comparison;
pub mod experiment;
pub mod explorer;
pub mod figures;
pub mod follow;
pub mod model;
pub mod options;
pub mod outage;
pub mod parts;
pub mod products;
pub mod recording;
pub mod replay;
pub mod report;
pub mod session;
pub mod sky;
pub mod streams;
pub mod tables;

/// What `host-sim list` says of this system.
pub(super) const DESCRIPTION: &str = "\
gnss        where a GPS receiver is, to a centimetre, from precise orbits and clocks
  scenario  days of a station under a synthetic sky, static and kinematic, with and without faults
  obs       RINEX 2, 3 or 4 observations of GPS on L1 and L2, as all these files perhaps packed with gzip; CRINEX
  sp3, clk  precise orbits (SP3) and clocks (RINEX), one file or more
  antex     phase centres of antennas (ANTEX)
  blq       ocean loading of stations (BLQ)
  truth     X,Y,Z of the marker in m, ECEF, on the command line";
