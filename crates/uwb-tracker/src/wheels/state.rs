//! The states of a robot on wheels.

/// Position in the room, m.
pub(crate) const X: usize = 0;
pub(crate) const Y: usize = 1;
/// What turns and stretches a way of the wheels into one in the room: k cos θ …
pub(crate) const COSINE: usize = 2;
/// … and k sin θ, with the wheels' scale k and the heading θ in which their own count began.
pub(crate) const SINE: usize = 3;
/// What is missing from the turn rate of the wheels or their gyroscope, rad in 100 s.
pub(crate) const DRIFT: usize = 4;
/// By what the turn rate is to be multiplied: the wheels' track may be another, and so may the sign be.
pub(crate) const GAIN: usize = 5;
/// What all ranges are too long by, m …
pub(crate) const BIAS: usize = 6;
/// … and by what more in 10 m of distance, m.
pub(crate) const EXCESS: usize = 7;
pub(crate) const COUNT: usize = 8;
