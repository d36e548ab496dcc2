//! Gains of observers with constant gain.

use kestirim_observer_design::{Complex, Discrete, Error as DesignError, place};
use nalgebra::{SMatrix, SVector};

use crate::Error;

/// L of x̂⁺ = A x̂ + B u + L (y − C x̂), the observer in predictor form, for these poles of discrete time (within the
/// unit circle; e^(p h) for a pole p in 1/s at an interval of h seconds).
///
/// Where every state is measured by itself and the poles are real, L = (A − diag(poles)) Cᵀ: each pole is that of one
/// state's error, which none of the others disturbs (the thesis' observer: its times to catch tell so). Else the poles
/// are placed where they are least sensitive ([`place`]).
///
/// # Errors
/// Those of [`place`].
pub fn observer_gain<const P: usize>(
    plant: &Discrete<4, 2>,
    c: &SMatrix<f64, P, 4>,
    poles: &[Complex<f64>; 4],
) -> Result<SMatrix<f64, 4, P>, DesignError> {
    // The identity, or one whose transpose is its inverse just as well.
    let every_state = P == 4 && c.transpose() * c == SMatrix::<f64, 4, 4>::identity();
    if every_state && poles.iter().all(|pole| pole.im == 0.0) {
        let errors = SMatrix::from_diagonal(&SVector::from(poles.map(|pole| pole.re)));
        return Ok((plant.a - errors) * c.transpose());
    }
    Ok(place(&plant.a, c, poles)?.gain)
}

/// K = A⁻¹ L of x̂ = x̂⁻ + K (y − C x̂⁻), the observer in current form, with which its poles are those of the
/// predictor form with L.
///
/// # Errors
/// [`Error::Singular`].
pub fn current_gain<const P: usize>(
    plant: &Discrete<4, 2>,
    predictor: &SMatrix<f64, 4, P>,
) -> Result<SMatrix<f64, 4, P>, Error> {
    Ok(plant.a.try_inverse().ok_or(Error::Singular)? * predictor)
}
