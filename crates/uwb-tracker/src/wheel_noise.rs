//! Process noise of wheel odometry: for the tracker, and for programs that smooth its track.

/// No robot drives faster, m/s, or turns faster, rad/s.
pub const LARGEST_SPEED: f64 = 100.0;

/// Variance that a metre of the way adds to each coordinate, m²/m: the wheels slip by 10 cm in a metre.
pub const SLIP: f64 = 0.01;
/// Variance that a metre of the way adds to the heading, rad²/m.
pub const WAY_TO_HEADING: f64 = 1e-4;
/// Variance that a radian of a turn adds to the heading, rad²/rad.
pub const TURN_TO_HEADING: f64 = 1e-3;
/// Without wheels the robot drives on somehow, at this speed at least, m/s, …
pub const UNKNOWN_SPEED: f64 = 0.5;
/// … in one direction for so long, s, …
pub const UNKNOWN_TIME: f64 = 2.0;
/// … and turns by this variance of the heading, rad²/s.
pub const UNKNOWN_TURN: f64 = 0.1;
/// Standard deviation of the gain of turns to begin with, beside its sign.
pub const GAIN_SIGMA: f64 = 0.5;
/// Standard deviation of the turns' drift to begin with, rad in 100 s.
pub const DRIFT_SIGMA: f64 = 1.0;
/// Age beyond which a sample of the wheels is not used, µs.
pub const FRESH_US: u64 = 2_000_000;
