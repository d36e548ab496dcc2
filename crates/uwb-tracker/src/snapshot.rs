//! Snapshot layouts of the trackers. Raise the version of a tracker whose stored form changes.

use crate::{
    DifferenceTracker, EpochSolver, HeightFinder, PublishedTracker, Tracker, WheelTracker,
};
use kestirim_scalar::Scalar;
use kestirim_snapshot::layout;

layout! {
    [T: Scalar, const D: usize, const N: usize, const A: usize] for Tracker<T, D, N, A>
        as "uwb/tracker", 5, T, [D, N, A];
    [T: Scalar, const D: usize, const N: usize, const A: usize] for DifferenceTracker<T, D, N, A>
        as "uwb/differences", 6, T, [D, N, A];
    [T: Scalar, const A: usize] for WheelTracker<T, A> as "uwb/wheels", 4, T, [A];
    [T: Scalar, const D: usize, const N: usize, const A: usize] for PublishedTracker<T, D, N, A>
        as "uwb/published", 1, T, [D, N, A];
    [T: Scalar, const A: usize] for HeightFinder<T, A> as "uwb/height", 1, T, [A];
    [T: Scalar, const A: usize] for EpochSolver<T, A> as "uwb/epochs", 1, T, [A];
}
