//! A room with anchors, and a tag in it.

use kestirim_scalar::Scalar;
use kestirim_uwb_tracker::{Anchor, RangeSample};
use nalgebra::{SVector, Vector3};

/// The corners of a room of 8 m × 6 m, two high and two low.
pub(crate) const CORNERS: [[f64; 3]; 4] =
    [[0.0, 0.0, 2.0], [8.0, 0.0, 0.3], [8.0, 6.0, 2.0], [0.0, 6.0, 0.3]];

pub(crate) fn anchors<T: Scalar>(places: &[[f64; 3]], bias: f64) -> Vec<Anchor<T>> {
    let anchor = |place: &[f64; 3]| Anchor {
        position: SVector::from(place.map(T::from_f64)),
        bias: T::from_f64(bias),
    };
    places.iter().map(anchor).collect()
}

pub(crate) fn distance(place: [f64; 3], tag: [f64; 3]) -> f64 {
    (Vector3::from(place) - Vector3::from(tag)).norm()
}

pub(crate) fn sample<T: Scalar>(time_us: u64, anchor: usize, range: f64) -> RangeSample<T> {
    RangeSample { time_us, anchor, range: T::from_f64(range) }
}

/// A check in double and single precision and in fixed point.
macro_rules! in_every_scalar {
    ($check:ident) => {
        $check::<f64>();
        $check::<f32>();
        $check::<kestirim_scalar::Q12_20>();
    };
}
pub(crate) use in_every_scalar;
