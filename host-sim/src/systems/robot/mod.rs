//! A robot among ultra-wideband anchors.
//!
//! `anchors`, `ranges`, `points`, `motion` read; `follow` is the trackers' one face; `feed` brings both
//! together for a [replay](replay::Replay) and for the experiment; `accuracy` compares.
//!
//! Frame: *room*, right-handed with z up, as the anchors are given.

pub mod accuracy;
pub mod anchors;
pub mod calibrate;
pub mod calibration;
pub mod chapter;
pub mod each_epoch;
pub mod experiment;
pub mod explorer;
pub mod feed;
pub mod figures;
pub mod follow;
pub mod limit;
pub mod motion;
pub mod options;
pub mod points;
pub mod published;
pub mod ranges;
pub mod recording;
pub mod replay;
pub mod scenario;
pub mod streams;
pub mod trace;
pub mod tuning;

pub use chapter::chapter;
pub use explorer::SOURCE;

/// What `host-sim list` says of this system.
pub(super) const DESCRIPTION: &str = "\
robot       where a tag is, from ranges to ultra-wideband anchors, with or without IMU and wheels
  scenario  the paper's office, 15 points of 50 epochs each and a straight line
  log       CSV with columns t,anchor,range in s and m, of a moving tag
  log       CSV with columns point,k,anchor,range in m, of a tag put down, epochs k 0.1 s apart
  anchors   CSV with columns anchor,x,y,z in m
  truth     CSV with columns t,x,y in s and m (z is not compared)
  points    CSV with columns point,x,y,z in m
  biases    CSV with columns anchor,bias in m (--calibration), as `calibrate robot` writes it
  imu       CSV with t and any of qw,qx,qy,qz gx,gy,gz ax,ay,az lax,lay,laz in SI
  odom      CSV with columns t,v_left,v_right,track in s, m/s and m";
