//! What stored estimators are. Raise the version of one that is stored otherwise than before.

use crate::detector::{Adaptive, AngularRateEnergy, FixedShoe, Magnitude, MovingVariance};
use crate::{Ekf, Lite, MagneticHeading, PathUncertainty, Tracker};
use kestirim_scalar::Scalar;
use kestirim_snapshot::{Layout, Name, layout};

layout! {
    [T: Scalar] for Ekf<T> as "pedestrian/ekf", 1, T, [];
    [T: Scalar] for Lite<T> as "pedestrian/lite", 1, T, [];
    [T: Scalar] for Adaptive<T> as "stance/adaptive", 2, T, [];
    [T: Scalar] for FixedShoe<T> as "stance/shoe", 1, T, [];
    [T: Scalar] for Magnitude<T> as "stance/magnitude", 1, T, [];
    [T: Scalar] for MovingVariance<T> as "stance/variance", 1, T, [];
    [T: Scalar] for AngularRateEnergy<T> as "stance/rate", 1, T, [];
    // A tracker is of its navigator and of its detector, whichever they are.
    [T: Scalar, N: Layout, D: Layout] for Tracker<T, N, D>
        as N::NAME, 5, T, [N::VERSION, Name::new(D::NAME).code(), D::VERSION];
    [T: Scalar] for PathUncertainty<T> as "pedestrian/path", 3, T, [];
    [T: Scalar] for MagneticHeading<T> as "pedestrian/north", 1, T, [];
}
