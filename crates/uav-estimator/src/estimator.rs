use kestirim_luenberger::{Plant, Predictor, PredictorGains};
use kestirim_observer_design::Discrete;
use kestirim_scalar::{Components, Scalar};
use nalgebra::{SMatrix, SVector};

use crate::{Error, KalmanFilter, Step, Transition};

/// An estimator for samples at a constant rate, in predictor form: its estimate is the prediction for the next
/// sample.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize, T::Accumulator: serde::Serialize",
        deserialize = "T: serde::Deserialize<'de>, T::Accumulator: serde::Deserialize<'de>"
    ))
)]
pub enum Estimator<T: Scalar, const P: usize> {
    /// Constant gain: a Luenberger observer or a steady-state Kalman filter.
    ConstantGain(Predictor<T, 4, 2, P>),
    /// Time-varying gain of a Kalman filter that starts from P₀.
    TimeVarying {
        /// The filter.
        filter: KalmanFilter<T, P>,
        /// The step from one sample to the next.
        transition: Transition<T>,
    },
}

impl<T: Scalar, const P: usize> Estimator<T, P> {
    /// Creates x̂⁺ = A x̂ + B u + L (y − C x̂) with this initial state, where L is from
    /// [`observer_gain`](crate::observer_gain), or the `predictor_gain` of
    /// [`riccati`](kestirim_observer_design::riccati).
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Observer`].
    pub fn constant_gain(
        plant: &Discrete<4, 2>,
        c: &SMatrix<f64, P, 4>,
        gain: &SMatrix<f64, 4, P>,
        start: &SVector<f64, 4>,
    ) -> Result<Self, Error> {
        if !start.iter().copied().all(f64::is_finite) {
            return Err(Error::NotFinite);
        }
        let gains = PredictorGains::new(&Plant { a: plant.a, b: plant.b, c: *c }, gain);
        Ok(Self::ConstantGain(Predictor::new(&gains, &start.map(T::from_f64))?))
    }

    /// Creates a [`KalmanFilter`] for outputs y = C x with noise of the standard deviations `sigmas`, and initial
    /// errors of the standard deviations `start_sigmas`.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn time_varying(
        step: &Step,
        c: &SMatrix<f64, P, 4>,
        sigmas: &SVector<f64, P>,
        start: &SVector<f64, 4>,
        start_sigmas: &SVector<f64, 4>,
    ) -> Result<Self, Error> {
        let filter = KalmanFilter::new(c, sigmas, start, start_sigmas)?;
        Ok(Self::TimeVarying { filter, transition: Transition::new(step) })
    }

    /// The estimate x̂ at the time of the next sample: α (rad), q (rad/s), V (m/s), θ (rad).
    pub fn estimate(&self) -> SVector<f64, 4> {
        match self {
            Self::ConstantGain(observer) => observer.estimate().map(T::to_f64),
            Self::TimeVarying { filter, .. } => filter.estimate(),
        }
    }

    /// Standard deviations of the estimation errors; `None` for a constant gain (for its steady state see
    /// [`error_covariance`](kestirim_observer_design::error_covariance)).
    pub fn sigma(&self) -> Option<SVector<f64, 4>> {
        match self {
            Self::ConstantGain(_) => None,
            Self::TimeVarying { filter, .. } => Some(filter.sigma()),
        }
    }

    /// Steps on with the inputs δe (rad), δt and the outputs of one sample; missing outputs are replaced by their
    /// predictions.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::Observer`] or [`Error::Estimate`]; the estimator is unchanged.
    pub fn step(
        &mut self,
        input: &SVector<f64, 2>,
        measured: &[Option<f64>; P],
    ) -> Result<(), Error> {
        let numbers = input.iter().chain(measured.iter().flatten());
        if !numbers.copied().all(f64::is_finite) {
            return Err(Error::NotFinite);
        }
        match self {
            Self::ConstantGain(observer) => {
                let measured = completed(observer, measured);
                Ok(observer.step(&input.map(T::from_f64), &measured)?)
            }
            Self::TimeVarying { filter, transition } => {
                let mut next = *filter;
                next.correct(measured)?;
                next.predict(transition, input)?;
                *filter = next;
                Ok(())
            }
        }
    }
}

/// The outputs as measured, or as predicted where they are missing.
fn completed<T: Scalar, const P: usize>(
    observer: &Predictor<T, 4, 2, P>,
    measured: &[Option<f64>; P],
) -> SVector<T, P> {
    let mut all = SVector::<T, P>::zeros();
    if measured.iter().any(Option::is_none) {
        all = -observer.innovation(&all);
    }
    for (value, measured) in all.as_array_mut().iter_mut().zip(measured) {
        if let Some(measured) = measured {
            *value = T::from_f64(*measured);
        }
    }
    all
}
