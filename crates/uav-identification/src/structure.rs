//! Matrices of the linear motion from its derivatives, with exact kinematics.

use nalgebra::{Matrix4, RowVector2, RowVector4, SMatrix};

use crate::flight::{OUTPUTS, Reference};
use crate::parameter::{COUNT, at};

/// Standard gravity g, m/s².
pub(crate) const GRAVITY: f64 = 9.806_65;

/// A linear model of deviations, in terms of the α that the vane shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Structure {
    pub(crate) a: Matrix4<f64>,
    pub(crate) b: SMatrix<f64, 4, 2>,
    pub(crate) c: SMatrix<f64, OUTPUTS, 4>,
    pub(crate) d: SMatrix<f64, OUTPUTS, 2>,
    /// The matrix that maps true states to logged ones.
    pub(crate) seen: Matrix4<f64>,
}

impl Structure {
    /// Creates the model from these values of [`crate::parameter::PARAMETERS`].
    ///
    /// With the specific forces along (`fx`) and across (`fz`) the path, V·(α̇ − q) = `fz` + g·cos γ and V̇ = `fx` −
    /// g·sin γ. An accelerometer along the body's axes measures these forces rotated by α, plus the pitch
    /// acceleration times its distance from the centre of mass.
    pub(crate) fn of(value: &[f64; COUNT], reference: &Reference) -> Self {
        let [alpha, _, airspeed, theta] = reference.state;
        let [az, ax] = reference.force;
        let (sin_climb, cos_climb) = (theta - alpha).sin_cos();
        let (sin, cos) = alpha.sin_cos();
        let a = Matrix4::from_rows(&[
            RowVector4::new(
                value[at::Z_ALPHA],
                1.0 + value[at::Z_RATE],
                value[at::Z_SPEED],
                -GRAVITY * sin_climb / airspeed,
            ),
            RowVector4::new(value[at::M_ALPHA], value[at::M_RATE], value[at::M_SPEED], 0.0),
            RowVector4::new(value[at::X_ALPHA], 0.0, value[at::X_SPEED], -GRAVITY * cos_climb),
            RowVector4::new(0.0, value[at::GYRO_SCALE], 0.0, 0.0),
        ]);
        let b = SMatrix::<f64, 4, 2>::from_rows(&[
            RowVector2::new(value[at::Z_ELEVATOR], value[at::Z_THROTTLE]),
            RowVector2::new(value[at::M_ELEVATOR], value[at::M_THROTTLE]),
            RowVector2::new(value[at::X_ELEVATOR], value[at::X_THROTTLE]),
            RowVector2::zeros(),
        ]);
        // The weight's component rotates with the path: γ = θ − α.
        let path = RowVector4::new(-1.0, 0.0, 0.0, 1.0);
        let rate = RowVector4::new(0.0, 1.0, 0.0, 0.0);
        let turned = RowVector4::new(1.0, 0.0, 0.0, 0.0);
        let across = (a.row(0) - rate) * airspeed + path * (GRAVITY * sin_climb);
        let along = a.row(2) + path * (GRAVITY * cos_climb);
        let (across_u, along_u) = (b.row(0) * airspeed, b.row(2).into_owned());
        let [x, z] = [value[at::ACCELEROMETER_X], value[at::ACCELEROMETER_Z]];
        let mut c = SMatrix::<f64, OUTPUTS, 4>::zeros();
        let mut d = SMatrix::<f64, OUTPUTS, 2>::zeros();
        c.set_row(4, &(across * cos + along * sin + turned * ax - a.row(1) * x));
        d.set_row(4, &(across_u * cos + along_u * sin - b.row(1) * x));
        c.set_row(5, &(along * cos - across * sin - turned * az + a.row(1) * z));
        d.set_row(5, &(along_u * cos - across_u * sin + b.row(1) * z));
        // A vane ahead of the centre of mass measures a smaller angle while the nose rises.
        let mut seen = Matrix4::identity();
        seen[(0, 0)] = value[at::VANE_SCALE];
        seen[(0, 1)] = -value[at::VANE_SCALE] * value[at::VANE_LEAD];
        let back = inverse(&seen);
        let mut c = c * back;
        c.fixed_view_mut::<4, 4>(0, 0).copy_from(&Matrix4::identity());
        Self { a: seen * a * back, b: seen * b, c, d, seen }
    }
}

/// The inverse of a matrix that differs from the identity in the first two entries of its first row.
pub(crate) fn inverse(seen: &Matrix4<f64>) -> Matrix4<f64> {
    let mut back = Matrix4::identity();
    back[(0, 0)] = 1.0 / seen[(0, 0)];
    back[(0, 1)] = -seen[(0, 1)] / seen[(0, 0)];
    back
}
