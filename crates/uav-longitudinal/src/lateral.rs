use libm::{cos, sin};
use nalgebra::SMatrix;

use crate::solve::solve;
use crate::{Airframe, Error, Inertia, LateralDerivatives, Trim};

impl Airframe {
    /// The lateral stability derivatives of a flight, from which the thesis' eqs 3.4.3 and 3.4.4 are formed.
    ///
    /// The coefficients are for rates about the body axes; the result is for rates about the stability axes, which
    /// lie below the body axes by the angle of attack.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::NotPositive`], [`Error::Singular`] for an impossible inertia.
    pub fn lateral(&self, trim: &Trim) -> Result<LateralDerivatives, Error> {
        self.check()?;
        let [alpha, _, airspeed, theta] = trim.state.into();
        if airspeed <= 0.0 {
            return Err(Error::NotPositive);
        }
        let force = 0.5 * self.air_density * airspeed * airspeed * self.wing_area;
        let damping = self.span / (2.0 * airspeed);
        // Rows Y, L, N; columns β, p, r, δa, δr.
        let mut of_body = SMatrix::<f64, 3, 5>::zeros();
        let rows = [self.side_force, self.rolling, self.yawing];
        for (row, coefficients) in rows.into_iter().enumerate() {
            let arm = if row == 0 { force } else { force * self.span };
            let numbers = [
                coefficients.sideslip,
                coefficients.roll_rate * damping,
                coefficients.yaw_rate * damping,
                coefficients.aileron,
                coefficients.rudder,
            ];
            for (column, number) in numbers.into_iter().enumerate() {
                of_body[(row, column)] = arm * number;
            }
        }
        let Inertia { x, z, xz, .. } = self.inertia;
        let mass = SMatrix::from([[self.mass, 0.0, 0.0], [0.0, x, -xz], [0.0, -xz, z]]);
        let accelerations = solve(mass, of_body)?;
        // Quantities about the body's x and z axes are rotated by α: moments from the left, rates from the right.
        let (sin_alpha, cos_alpha) = (sin(alpha), cos(alpha));
        let turned =
            |x: f64, z: f64| [cos_alpha * x + sin_alpha * z, cos_alpha * z - sin_alpha * x];
        let column = |k: usize| {
            let [l, n] = turned(accelerations[(1, k)], accelerations[(2, k)]);
            [accelerations[(0, k)], l, n]
        };
        let (p, r) = (column(1), column(2));
        let rates: [[f64; 2]; 3] = core::array::from_fn(|row| turned(p[row], r[row]));
        let derivatives = LateralDerivatives {
            airspeed,
            gravity: self.gravity,
            pitch_angle: theta,
            climb_angle: theta - alpha,
            sideslip: column(0),
            roll_rate: rates.map(|[about_x, _]| about_x),
            yaw_rate: rates.map(|[_, about_z]| about_z),
            aileron: column(3),
            rudder: column(4),
        };
        derivatives.descriptor().resolve()?;
        Ok(derivatives)
    }
}
