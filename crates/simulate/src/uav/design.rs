//! Gains of the thesis' estimators.

use kestirim_observer_design::{Complex, Discrete, Error, error_covariance, riccati};
use kestirim_replay::uav::{Noise, Poles, discrete};
use kestirim_scalar::Scalar;
use kestirim_uav_estimator::{Error as EstimatorError, Estimator, Step, observer_gain};
use nalgebra::{SMatrix, SVector};

use crate::uav::scenario::INTERVAL_S;

/// An estimator to be designed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// The steady-state filter for a variance of the input noise of this multiple of that of the output noise, each
    /// equal for all channels.
    Ratio(f64),
    /// The steady-state filter for the true noise.
    Matched(Noise),
    /// The filter for the true noise, with a time-varying gain that starts from the initial covariance.
    TimeVarying(Noise),
    /// A Luenberger observer with these poles, 1/s.
    Luenberger(Poles),
}

impl Kind {
    /// The name for tables.
    pub fn name(&self) -> String {
        match self {
            Self::Ratio(ratio) => format!("Kalman Q/R = {ratio}"),
            Self::Matched(_) => "Kalman, steady".to_owned(),
            Self::TimeVarying(_) => "Kalman, time-varying".to_owned(),
            Self::Luenberger(poles) => {
                let one = |Complex { re, im }: Complex<f64>| {
                    if im == 0.0 { re.to_string() } else { format!("{re}{im:+}i") }
                };
                format!("Luenberger {}", poles.map(one).join(" "))
            }
        }
    }

    /// The family of the estimator.
    pub fn family(&self) -> Family {
        match self {
            Self::Ratio(_) | Self::Matched(_) => Family::Kalman,
            Self::TimeVarying(_) => Family::TimeVarying,
            Self::Luenberger(_) => Family::Luenberger,
        }
    }

    /// The gain L of x̂⁺ = A·x̂ + B·u + L·(y − C·x̂); for a time-varying filter the gain to which it converges.
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
            Self::Luenberger(poles) => observer_gain(plant, c, &discrete(*poles, INTERVAL_S)),
        }
    }

    /// The running estimator, from a start that is `off` from the truth; only a time-varying filter uses `off`.
    ///
    /// # Errors
    /// Why it does not exist.
    pub fn estimator<T: Scalar, const P: usize>(
        &self,
        plant: &Discrete<4, 2>,
        c: &SMatrix<f64, P, 4>,
        start: &SVector<f64, 4>,
        off: &SVector<f64, 4>,
    ) -> Result<Estimator<T, P>, EstimatorError> {
        if let Self::TimeVarying(noise) = self {
            let step = Step { transition: *plant, noise: noise.process(plant) };
            let row = |output: usize| std::array::from_fn(|state| c[(output, state)]);
            let sigmas = SVector::from_fn(|output, _| noise.of_output(&row(output)));
            return Estimator::time_varying(&step, c, &sigmas, start, off);
        }
        Estimator::constant_gain(plant, c, &self.gain(plant, c)?, start)
    }
}

/// A family of estimators.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Family {
    /// Steady-state Kalman filters.
    Kalman,
    /// Time-varying Kalman filters, with P₀.
    TimeVarying,
    /// Luenberger observers.
    Luenberger,
}

/// The RMSE of α, q, V, θ of a converged estimator, from the Lyapunov equation.
///
/// # Errors
/// Why there is none.
pub fn settled<const P: usize>(
    c: &SMatrix<f64, P, 4>,
    plant: &Discrete<4, 2>,
    kind: &Kind,
    noise: &Noise,
) -> Result<[f64; 4], Error> {
    let gain = kind.gain(plant, c)?;
    let (q, r) = (noise.process(plant), noise.measurement(c));
    let process = (&SMatrix::<f64, 4, 4>::identity(), &q);
    let covariance = error_covariance((&plant.a, c), &gain, process, &r)?;
    Ok(covariance.diagonal().map(f64::sqrt).into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::stream;
    use kestirim_replay::uav::Plant;

    use crate::uav::scenario::{Inputs, START, fly};

    #[test]
    fn a_time_varying_filter_settles_at_the_steady_one() {
        let plant = Plant::P3.discrete(INTERVAL_S);
        let c = kestirim_uav_longitudinal::rate_airspeed_and_pitch();
        let (start, off) = (SVector::from(START), SVector::from([0.1, 0.1, 5.0, 0.1]));
        let new = |kind: Kind| kind.estimator::<f64, 3>(&plant, &c, &start, &off).unwrap();
        let mut varying = new(Kind::TimeVarying(Noise::SENSORS));
        let mut steady = new(Kind::Matched(Noise::SENSORS));
        let flight = fly(plant, START.into(), Inputs::Sine, Noise::SENSORS, stream(1, 0));
        for sample in flight.take(8000) {
            let measured = sample.measured(&c);
            varying.step(&sample.u, &measured).unwrap();
            steady.step(&sample.u, &measured).unwrap();
        }
        assert!((varying.estimate() - steady.estimate()).amax() < 1e-8);
    }
}
