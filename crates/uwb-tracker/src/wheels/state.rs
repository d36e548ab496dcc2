//! Indices of the states of a robot on wheels.

/// Position in the room, x and y, m.
pub(crate) const X: usize = 0;
pub(crate) const Y: usize = 1;
/// k cos θ, with the wheels' scale k and the heading θ at which their count began; converts ways of the wheels to the
/// room frame.
pub(crate) const COSINE: usize = 2;
/// k sin θ, with the wheels' scale k and the heading θ at which their count began.
pub(crate) const SINE: usize = 3;
/// Drift: the amount missing from the turn rate of the wheels or their gyroscope, rad in 100 s.
pub(crate) const DRIFT: usize = 4;
/// Gain of the turn rate: the wheels' track may differ, and so may the sign.
pub(crate) const GAIN: usize = 5;
/// Bias common to all ranges, m.
pub(crate) const BIAS: usize = 6;
/// Additional excess of ranges in 10 m of distance, m.
pub(crate) const EXCESS: usize = 7;
pub(crate) const COUNT: usize = 8;
