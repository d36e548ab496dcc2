use kestirim_scalar::Columns;
use nalgebra::SMatrix;

use crate::Error;
use crate::solve::solve;

/// A linear model ẋ = A·x + B·u of deviations from a steady flight: four states, two inputs, continuous time.
///
/// It is in `f64`: a model is trimmed, linearised and discretised where an estimator is designed. What runs on the
/// target is discrete, and in any scalar type.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StateSpace {
    /// System matrix A.
    pub a: SMatrix<f64, 4, 4>,
    /// Input matrix B.
    pub b: SMatrix<f64, 4, 2>,
}

/// A linear model in descriptor form, E·ẋ = A·x + B·u, which results from derivatives with respect to accelerations.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Descriptor {
    /// Matrix E of the state's derivative.
    pub e: SMatrix<f64, 4, 4>,
    /// System matrix A.
    pub a: SMatrix<f64, 4, 4>,
    /// Input matrix B.
    pub b: SMatrix<f64, 4, 2>,
}

impl Descriptor {
    /// The state-space form with E⁻¹·A and E⁻¹·B.
    ///
    /// # Errors
    /// [`Error::Singular`] if E has no inverse; [`Error::NotFinite`].
    pub fn resolve(&self) -> Result<StateSpace, Error> {
        let model = StateSpace { a: solve(self.e, self.a)?, b: solve(self.e, self.b)? };
        model.finite()
    }
}

impl StateSpace {
    /// Spectral densities of white noise on ẋ that represents a model with a relative error `wrong` in every
    /// coefficient, for `deviations` of states and inputs of this size that last for `lasting` (s). Zero on θ̇, which
    /// is kinematics.
    pub fn process_noise(&self, wrong: f64, deviations: &[f64; 6], lasting: f64) -> [f64; 4] {
        let (a, b) = (self.a.as_columns(), self.b.as_columns());
        core::array::from_fn(|state| {
            if state == 3 {
                return 0.0;
            }
            let parts = a.iter().chain(b).map(|column| column[state]);
            let squares = parts.zip(deviations).map(|(part, deviation)| {
                let off = wrong * part * deviation;
                off * off
            });
            lasting * squares.sum::<f64>()
        })
    }

    pub(crate) fn finite(self) -> Result<Self, Error> {
        if self.a.iter().chain(self.b.iter()).all(|number| number.is_finite()) {
            Ok(self)
        } else {
            Err(Error::NotFinite)
        }
    }
}
