//! Process noise of wheel odometry, for the tracker and for programs that smooth its track.

/// Largest plausible speed of a robot, m/s, and largest turn rate, rad/s.
pub const LARGEST_SPEED: f64 = 100.0;

/// Variance per metre travelled that is added to each coordinate, m²/m: a slip of 10 cm in a metre.
pub const SLIP: f64 = 0.01;
/// Variance per metre travelled that is added to the heading, rad²/m.
pub const WAY_TO_HEADING: f64 = 1e-4;
/// Variance per radian turned that is added to the heading, rad²/rad.
pub const TURN_TO_HEADING: f64 = 1e-3;
/// Lowest speed that is assumed for a robot without odometry, m/s.
pub const UNKNOWN_SPEED: f64 = 0.5;
/// Time for which a robot without odometry is assumed to keep its direction, s.
pub const UNKNOWN_TIME: f64 = 2.0;
/// Variance of the heading that a robot without odometry gains, rad²/s.
pub const UNKNOWN_TURN: f64 = 0.1;
/// Initial standard deviation of the gain of turns, apart from its sign.
pub const GAIN_SIGMA: f64 = 0.5;
/// Initial standard deviation of the drift of turns, rad in 100 s.
pub const DRIFT_SIGMA: f64 = 1.0;
/// Age beyond which an odometry sample is not used, µs.
pub const FRESH_US: u64 = 2_000_000;
