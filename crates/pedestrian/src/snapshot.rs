//! Layouts of stored estimators. Raise the version of one whose stored form changes.

use crate::detector::{Adaptive, AngularRateEnergy, FixedShoe, Magnitude, MovingVariance};
use crate::{Ekf, Lite, MagneticHeading, PathUncertainty, Tracker};
use kestirim_scalar::Scalar;
use kestirim_snapshot::{Layout, Name, layout};

layout! {
    [T: Scalar] for Ekf<T> as "pedestrian/ekf", 1, T, [];
    [T: Scalar] for Lite<T> as "pedestrian/lite", 1, T, [];
    [T: Scalar] for Adaptive<T> as "stance/adaptive", 3, T, [];
    [T: Scalar] for FixedShoe<T> as "stance/shoe", 1, T, [];
    [T: Scalar] for Magnitude<T> as "stance/magnitude", 1, T, [];
    [T: Scalar] for MovingVariance<T> as "stance/variance", 1, T, [];
    [T: Scalar] for AngularRateEnergy<T> as "stance/rate", 1, T, [];
    // The layout of a tracker includes those of its navigator and its detector.
    [T: Scalar, N: Layout, D: Layout] for Tracker<T, N, D>
        as N::NAME, 7, T, [N::VERSION, Name::new(D::NAME).code(), D::VERSION];
    [T: Scalar] for PathUncertainty<T> as "pedestrian/path", 3, T, [];
    [T: Scalar] for MagneticHeading<T> as "pedestrian/north", 2, T, [];
}
