use nalgebra::SMatrix;

use crate::Error;
use crate::solve::solve;

/// ẋ = A·x + B·u: four states, two inputs, continuous time, deviations from a steady flight.
///
/// In `f64`: a model is trimmed, linearised and discretised where an estimator is designed. What then runs
/// on a target is discrete, and in any scalar.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StateSpace {
    /// A.
    pub a: SMatrix<f64, 4, 4>,
    /// B.
    pub b: SMatrix<f64, 4, 2>,
}

/// E·ẋ = A·x + B·u: as derivatives with respect to accelerations leave it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Descriptor {
    /// E.
    pub e: SMatrix<f64, 4, 4>,
    /// A.
    pub a: SMatrix<f64, 4, 4>,
    /// B.
    pub b: SMatrix<f64, 4, 2>,
}

impl Descriptor {
    /// E⁻¹·A and E⁻¹·B.
    ///
    /// # Errors
    /// [`Error::Singular`] if E has no inverse; [`Error::NotFinite`].
    pub fn resolve(&self) -> Result<StateSpace, Error> {
        let model = StateSpace { a: solve(self.e, self.a)?, b: solve(self.e, self.b)? };
        model.finite()
    }
}

impl StateSpace {
    pub(crate) fn finite(self) -> Result<Self, Error> {
        if self.a.iter().chain(self.b.iter()).all(|number| number.is_finite()) {
            Ok(self)
        } else {
            Err(Error::NotFinite)
        }
    }
}
