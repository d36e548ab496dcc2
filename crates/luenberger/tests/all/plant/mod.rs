//! A plant without special structure, and an observer of it.

use kestirim_luenberger::{Plant, PredictorGains};
use nalgebra::{Matrix2x3, Matrix3, Matrix3x2, Vector3};

pub(crate) const PLANT: Plant<3, 1, 2> = Plant {
    a: Matrix3::new(0.98, 0.1, 0.0, -0.05, 0.9, 0.02, 0.1, 0.0, 0.999),
    b: Vector3::new(0.1, 0.05, 0.0),
    c: Matrix2x3::new(1.0, 0.0, 0.2, 0.0, 0.0, 1.0),
};
pub(crate) const GAIN: Matrix3x2<f64> = Matrix3x2::new(0.3, 0.0, 0.1, 0.05, 0.0, 0.2);
pub(crate) const GAINS: PredictorGains<3, 1, 2> = PredictorGains::new(&PLANT, &GAIN);
pub(crate) const START: Vector3<f64> = Vector3::new(1.0, -2.0, 3.0);
