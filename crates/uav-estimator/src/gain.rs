//! Gains of observers with constant gain.

use kestirim_observer_design::{Complex, Discrete, Error as DesignError, place};
use nalgebra::{SMatrix, SVector};

use crate::Error;

/// The gain L of the observer in predictor form, x̂⁺ = A x̂ + B u + L (y − C x̂), for these discrete-time poles.
///
/// The poles are within the unit circle: e^(p h) for a pole p in 1/s and an interval of h seconds.
///
/// If every state is measured directly and the poles are real, L = (A − diag(poles)) Cᵀ: each pole is that of one
/// state's error, undisturbed by the others (the thesis' observer, as its settling times show). Otherwise the poles
/// are placed where they are least sensitive ([`place`]).
///
/// # Errors
/// Those of [`place`].
pub fn observer_gain<const P: usize>(
    plant: &Discrete<4, 2>,
    c: &SMatrix<f64, P, 4>,
    poles: &[Complex<f64>; 4],
) -> Result<SMatrix<f64, 4, P>, DesignError> {
    // The identity, or any other C whose transpose is its inverse.
    let every_state = P == 4 && c.transpose() * c == SMatrix::<f64, 4, 4>::identity();
    if every_state && poles.iter().all(|pole| pole.im == 0.0) {
        let errors = SMatrix::from_diagonal(&SVector::from(poles.map(|pole| pole.re)));
        return Ok((plant.a - errors) * c.transpose());
    }
    Ok(place(&plant.a, c, poles)?.gain)
}

/// The gain K = A⁻¹ L of the observer in current form, x̂ = x̂⁻ + K (y − C x̂⁻), which has the same poles as the
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
