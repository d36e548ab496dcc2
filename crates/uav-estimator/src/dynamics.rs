use kestirim_observer_design::{Discrete, discrete_noise, zero_order_hold};
use kestirim_uav_longitudinal::StateSpace;
use nalgebra::{SMatrix, SVector};

use crate::Error;

/// Steps of a model of discrete time that one interval may take.
const MOST_STEPS: f64 = 1e5;
/// By this share of its interval a model of discrete time may be off.
const TOLERANCE: f64 = 0.1;

/// A linear model of an aircraft near its steady flight: states α (rad), q (rad/s), V (m/s), θ (rad), inputs δe
/// (rad) and δt (0 to 1), all of them deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Dynamics {
    /// ẋ = A x + B u, for intervals of any length.
    Continuous(StateSpace),
    /// x⁺ = A x + B u, for multiples of one interval.
    Discrete {
        /// A and B of one step.
        step: Discrete<4, 2>,
        /// Interval of a step, s.
        interval: f64,
    },
}

/// x⁺ = A x + B u + w: what a model does in an interval, with inputs that are held.
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
    /// Step of the model over `interval` (s), where white noise of these standard deviations (rad; 1) a `sample` (s)
    /// reaches the inputs δe and δt.
    ///
    /// # Errors
    /// [`Error::WrongInterval`] of a model of discrete time; [`Error::Design`] if an argument or the answer is
    /// not finite, or an interval of continuous time is not positive.
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
                Ok(repeated(step, &(step.b * variances * step.b.transpose()), count as u32))
            }
        }
    }
}

/// A sequence of `count` steps, each with noise of this covariance.
fn repeated(step: &Discrete<4, 2>, once: &SMatrix<f64, 4, 4>, count: u32) -> Step {
    let mut all = Discrete { a: SMatrix::identity(), b: SMatrix::zeros() };
    let mut noise = SMatrix::zeros();
    for _ in 0..count {
        all = Discrete { a: step.a * all.a, b: step.a * all.b + step.b };
        noise = step.a * noise * step.a.transpose() + once;
    }
    Step { transition: all, noise }
}
