//! The theoretical bound for any estimator, from the geometry and the error model alone.

use nalgebra::{Matrix3, Matrix4, Matrix4x3};

use crate::systems::robot::simulate::scenario::{
    ANCHOR_SIGMA, ANCHORS, EPOCHS, LINK_SIGMA, NOISE_SIGMA,
};

/// The knowledge of an estimator about the biases.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Knowledge {
    /// All links have a common bias, whose value is unknown.
    Nothing,
    /// Each anchor's bias is known; what a link adds to it is not.
    Anchors,
}

/// The Cramér–Rao bound of the mean error at a position (m), without reflections and persons.
///
/// The errors of the four links' means are independent, with the variance of their unknown part; the mean length of a
/// two-dimensional normal error is √(π/4) of its root mean square if it is isotropic (nearly so among four corners).
pub fn mean_error_limit([x, y]: [f64; 2], knowledge: Knowledge) -> f64 {
    let own = match knowledge {
        Knowledge::Nothing => ANCHOR_SIGMA,
        Knowledge::Anchors => 0.0,
    };
    let variance = own.powi(2) + LINK_SIGMA.powi(2) + NOISE_SIGMA.powi(2) / EPOCHS as f64;
    let mut rows = Matrix4x3::zeros();
    for (anchor, place) in ANCHORS.iter().enumerate() {
        let offset = [x - place[0], y - place[1]];
        let length = offset[0].hypot(offset[1]);
        rows[(anchor, 0)] = offset[0] / length;
        rows[(anchor, 1)] = offset[1] / length;
        rows[(anchor, 2)] = 1.0;
    }
    let weights = Matrix4::identity() / variance;
    let mut information: Matrix3<f64> = rows.transpose() * weights * rows;
    if knowledge == Knowledge::Anchors {
        // The common bias is known as well.
        information[(2, 2)] += 1e12;
    }
    let covariance = information.try_inverse().unwrap_or_default();
    let mean_square: f64 = covariance[(0, 0)] + covariance[(1, 1)];
    (std::f64::consts::FRAC_PI_4 * mean_square).sqrt()
}
