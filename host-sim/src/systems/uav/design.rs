//! Gains: what each estimator of the thesis is.

use kestirim_observer_design::{Complex, Discrete, Error, place, riccati};
use nalgebra::{SMatrix, SVector};
use serde::Serialize;

use super::scenario::{INTERVAL_S, Noise};

/// Poles of the slow set of the experiment, 1/s; the card has the time to catch that they lead to.
pub const SLOW: [f64; 4] = [-2.0, -1.5, -8.0, -3.5];
/// Poles that lie close together.
pub const MIDDLE: [f64; 4] = [-3.0, -3.5, -4.0, -4.5];
/// Poles that lead to the thesis' quarter of a second.
pub const FAST: [f64; 4] = [-12.0, -14.0, -16.0, -18.0];

/// An estimator to be designed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// The steady-state filter for noise of so many times the variance on the inputs as on the outputs, which
    /// all have the same.
    Ratio(f64),
    /// The steady-state filter for the noise there is.
    Matched(Noise),
    /// The filter for the noise there is whose gain starts from what is known of the start.
    TimeVarying(Noise),
    /// An observer with these poles, 1/s.
    Luenberger([f64; 4]),
}

impl Kind {
    /// For a table.
    pub fn name(&self) -> String {
        match self {
            Self::Ratio(ratio) => format!("Kalman Q/R = {ratio}"),
            Self::Matched(_) => "Kalman, steady".to_owned(),
            Self::TimeVarying(_) => "Kalman, time-varying".to_owned(),
            Self::Luenberger(poles) => {
                format!("Luenberger {}", poles.map(|pole| pole.to_string()).join(" "))
            }
        }
    }

    /// Of which family it is.
    pub fn family(&self) -> Family {
        match self {
            Self::Ratio(_) | Self::Matched(_) => Family::Kalman,
            Self::TimeVarying(_) => Family::TimeVarying,
            Self::Luenberger(_) => Family::Luenberger,
        }
    }

    /// L of x̂⁺ = A·x̂ + B·u + L·(y − C·x̂); for a time-varying filter the one at which it settles.
    ///
    /// # Errors
    /// Why there is none.
    pub fn gain<const P: usize>(
        &self,
        plant: &Discrete<4, 2>,
        c: &SMatrix<f64, P, 4>,
    ) -> Result<SMatrix<f64, 4, P>, Error> {
        match self {
            Self::Ratio(ratio) => {
                let q = plant.b * plant.b.transpose() * *ratio;
                Ok(riccati(&plant.a, c, &q, &SMatrix::identity())?.predictor_gain)
            }
            Self::Matched(noise) | Self::TimeVarying(noise) => {
                let (q, r) = (noise.process(plant), noise.measurement(c));
                Ok(riccati(&plant.a, c, &q, &r)?.predictor_gain)
            }
            Self::Luenberger(poles) => {
                luenberger(plant, c, poles.map(|re| Complex { re, im: 0.0 }), INTERVAL_S)
            }
        }
    }
}

/// Kinds of estimators.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Family {
    /// Steady-state Kalman filters.
    Kalman,
    /// Kalman filters with P₀.
    TimeVarying,
    /// Luenberger observers.
    Luenberger,
}

/// The gain of an observer with these poles (1/s) at an interval (s).
///
/// Where every state is measured and the poles are real, L = A − diag(eᵖʰ): each pole is that of one state's error,
/// which none of the others disturbs. This is what the thesis' times to catch tell of; else the poles are placed
/// where nothing is sensitive.
///
/// # Errors
/// Why there is none.
pub fn luenberger<const P: usize>(
    plant: &Discrete<4, 2>,
    c: &SMatrix<f64, P, 4>,
    poles: [Complex<f64>; 4],
    interval: f64,
) -> Result<SMatrix<f64, 4, P>, Error> {
    let discrete = poles.map(|pole| {
        let size = (pole.re * interval).exp();
        let (sin, cos) = (pole.im * interval).sin_cos();
        Complex { re: size * cos, im: size * sin }
    });
    // The identity, or one whose transpose is its inverse just as well.
    let every_state = P == 4 && c.transpose() * c == SMatrix::<f64, 4, 4>::identity();
    if every_state && poles.iter().all(|pole| pole.im == 0.0) {
        let errors = SMatrix::from_diagonal(&SVector::from(discrete.map(|pole| pole.re)));
        return Ok((plant.a - errors) * c.transpose());
    }
    Ok(place(&plant.a, c, &discrete)?.gain)
}
