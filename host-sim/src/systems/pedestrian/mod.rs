//! A foot-mounted IMU and zero-velocity updates.
//!
//! `log` → `resample` → `run` → `accuracy` is a [replay](replay::Replay);
//! `scenario` → `sensor` → `log` → `run` → `metrics` is the [experiment].
//!
//! Frames: *body* is the sensor's own, as mounted on the foot; *room* is right-handed with z up, its
//! origin at the start of the walk.

pub mod accuracy;
pub mod chapter;
pub mod experiment;
pub mod explorer;
pub mod figures;
pub mod gait;
pub mod kinematics;
pub mod log;
pub mod options;
pub mod placement;
pub mod recording;
pub mod replay;
pub mod resample;
pub mod run;
pub mod scenario;
pub mod sensor;
pub mod streams;
pub mod trace;
pub mod track;
pub mod truth;
pub(crate) mod warning;

pub use chapter::chapter;
pub use explorer::SOURCE;

/// What `host-sim list` says of this system.
pub(super) const DESCRIPTION: &str = "\
pedestrian  where a foot walked, from a foot-mounted IMU with zero-velocity updates
  scenario  the paper's 12.60 m route through a flat, 7 walks each at 50 and at 100 Hz
  log       CSV with columns t,ax,ay,az,gx,gy,gz in s, m/s², rad/s (gt_x,gt_y,gt_z in m = truth)
  log       Razor text, blank-separated: time in ms, 3 × specific force in g, 3 × rate in °/s
  truth     CSV of footprints with columns t,x,y in s and m";

/// Standard gravity, m/s²: the g in which accelerometers are specified.
///
/// The paper rounds it to 9.8; the difference, 0.07 %, is below its sensor's scale error.
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// What the sensor says at one moment, in the body frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time of the log's own clock, µs.
    pub time_us: u64,
    /// Specific force, m/s²: +1 g upwards at rest.
    pub specific_force: [f64; 3],
    /// Angular rate, rad/s, right-handed.
    pub angular_rate: [f64; 3],
}
