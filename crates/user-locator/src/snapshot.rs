//! Snapshot layouts of the estimators. Raise the version of an estimator whose stored form changes.

use crate::{
    Beacon, BeaconEstimate, BeaconSearch, GroundEstimate, GroundSearch, Locator, PublishedLocator,
    Tracker,
};
use kestirim_scalar::Scalar;
use kestirim_snapshot::{Layout, Name, layout};

layout! {
    [T: Scalar, const L: usize, const M: usize, const D: usize, C: Layout] for Locator<T, L, M, D, C>
        as "user/locator", 1, T, [L, M, D, Name::new(C::NAME).code()], infinite;
    [T: Scalar, const L: usize, C: Layout] for Tracker<T, L, C>
        as "user/tracker", 1, T, [L, Name::new(C::NAME).code()], infinite;
    [T: Scalar, const L: usize] for PublishedLocator<T, L> as "user/published", 1, T, [L], infinite;
    [T: Scalar, const M: usize] for Beacon<T, M> as "beacon", 1, T, [M];
    [T: Scalar, const L: usize] for BeaconEstimate<T, L> as "beacon/estimate", 1, T, [L], infinite;
    [T: Scalar, const M: usize, const N: usize] for BeaconSearch<T, M, N> as "beacon/search", 1, T, [M, N];
    [T: Scalar, const L: usize] for GroundEstimate<T, L> as "ground/estimate", 1, T, [L], infinite;
    [T: Scalar, const M: usize, const N: usize] for GroundSearch<T, M, N> as "ground/search", 2, T, [M, N];
}
