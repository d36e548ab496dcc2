use kestirim_observer_design::{Discrete, discrete_noise, zero_order_hold};
use kestirim_uav_longitudinal::StateSpace;
use nalgebra::{SMatrix, SVector};

use crate::Error;

/// Largest number of steps of a discrete-time model in one interval.
const MOST_STEPS: f64 = 1e5;
/// Tolerance of an interval, as a share of the discrete-time model's own.
const TOLERANCE: f64 = 0.1;

/// A linear model of an aircraft near its steady flight, with states α (rad), q (rad/s), V (m/s), θ (rad) and inputs
/// δe (rad) and δt (0 to 1), all as deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Dynamics {
    /// Continuous time, ẋ = A x + B u, for intervals of any length.
    Continuous(StateSpace),
    /// Discrete time, x⁺ = A x + B u, for multiples of one interval.
    Discrete {
        /// A and B of one step.
        step: Discrete<4, 2>,
        /// Interval of a step, s.
        interval: f64,
    },
}

/// The model's transition over an interval with held inputs: x⁺ = A x + B u + w.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Step {
    /// A and B.
    pub transition: Discrete<4, 2>,
    /// Q, the covariance of w, in the states' units.
    pub noise: SMatrix<f64, 4, 4>,
}

impl Dynamics {
    /// The step of the model over `interval` (s), with white noise of the standard deviations `noise` (rad; 1) per
    /// `sample` (s) on the inputs δe and δt.
    ///
    /// # Errors
    /// [`Error::WrongInterval`] for a discrete-time model; [`Error::Design`] if an argument or the result is not
    /// finite, or an interval of a continuous-time model is not positive.
    pub fn over(&self, interval: f64, sample: f64, noise: &SVector<f64, 2>) -> Result<Step, Error> {
        let variances = SMatrix::from_diagonal(&noise.map(|sigma| sigma * sigma));
        match self {
            Self::Continuous(StateSpace { a, b }) => {
                let density = b * variances * b.transpose() * sample;
                let transition = zero_order_hold(a, b, interval)?;
                Ok(Step { transition, noise: discrete_noise(a, &density, interval)? })
            }
            Self::Discrete { step, interval: own } => {
                let count = libm::round(interval / own);
                let whole = (1.0..=MOST_STEPS).contains(&count)
                    && (interval - count * own).abs() <= TOLERANCE * own;
                if !whole {
                    return Err(Error::WrongInterval { own: *own, found: interval });
                }
                // Noise that is white over a sample, not over a step: a step sees the more of it the shorter it is.
                let once = step.b * variances * step.b.transpose() * (sample / own);
                Ok(repeated(step, &once, count as u32))
            }
        }
    }
}

/// Combines `count` steps, each with noise of the covariance `once`.
fn repeated(step: &Discrete<4, 2>, once: &SMatrix<f64, 4, 4>, count: u32) -> Step {
    let mut all = Discrete { a: SMatrix::identity(), b: SMatrix::zeros() };
    let mut noise = SMatrix::zeros();
    for _ in 0..count {
        all = Discrete { a: step.a * all.a, b: step.a * all.b + step.b };
        noise = step.a * noise * step.a.transpose() + once;
    }
    Step { transition: all, noise }
}
