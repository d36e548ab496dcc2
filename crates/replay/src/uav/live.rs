//! Estimators for flights in progress.

use std::fmt::Debug;

use kestirim_health::Health;
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_uav_estimator::{self as uav, FlightObserver};
use nalgebra::{SMatrix, SVector};

use super::augmented::Augmented;
use super::estimators::{Assumed, Filter, KEPT, filter, rows, sized};
use super::{EstimatorKind, Model, Options, Poles, Sample, discrete};
use crate::ScalarKind;

/// An estimator that follows a flight in progress, as [`Deviations::follow`](super::Deviations::follow) does for a
/// complete one.
pub trait Follow: Debug {
    /// Sets the usual length of an interval, s.
    fn set_usual(&mut self, usual: f64);

    /// Processes a sample: deviations from the steady flight, of the outputs in their order.
    ///
    /// # Errors
    /// The error of the estimator, which remains as before.
    fn take(&mut self, sample: &Sample) -> Result<(), uav::Error>;

    /// The deviations of α, q, V, θ after the last sample.
    fn estimate(&self) -> SVector<f64, 4>;

    /// The doubts about the estimate; `None` while there is none.
    fn health(&self) -> Option<Health>;
}

/// Builds the chosen estimator for the given outputs of a model, at most three for an observer. The usual interval is
/// set later, from the samples.
///
/// # Errors
/// Why it cannot be built.
pub fn build(
    model: &Model,
    outputs: &[usize],
    options: &Options,
) -> Result<Box<dyn Follow>, uav::Error> {
    match options.scalar {
        ScalarKind::F32 => build_in::<f32>(model, outputs, options),
        ScalarKind::F64 => build_in::<f64>(model, outputs, options),
        ScalarKind::Fixed => build_in::<Q16_16>(model, outputs, options),
    }
}

fn build_in<T: Scalar + 'static>(
    model: &Model,
    outputs: &[usize],
    options: &Options,
) -> Result<Box<dyn Follow>, uav::Error> {
    Ok(match (options.estimator, outputs.len()) {
        (EstimatorKind::Kalman, _) if model.extended.is_some() => {
            Box::new(Augmented::<T>::new(model, outputs, options, 1.0, 0.0)?)
        }
        (EstimatorKind::Kalman, _) => {
            filter::<T>(model, outputs, &Assumed::of(model, outputs, options), 0.0)?
        }
        (EstimatorKind::Luenberger, 1) => Box::new(Observer::<T, 1>::new(model, outputs, options)),
        (EstimatorKind::Luenberger, 2) => Box::new(Observer::<T, 2>::new(model, outputs, options)),
        (EstimatorKind::Luenberger, 3) => Box::new(Observer::<T, 3>::new(model, outputs, options)),
        (EstimatorKind::Luenberger, _) => return Err(uav::Error::NoRoom),
    })
}

impl<T: Scalar> Follow for Filter<T> {
    fn set_usual(&mut self, usual: f64) {
        Self::set_usual(self, usual);
    }

    fn take(&mut self, sample: &Sample) -> Result<(), uav::Error> {
        Self::take(self, &sized(sample)).map(drop)
    }

    fn estimate(&self) -> SVector<f64, 4> {
        self.filter().estimate()
    }

    fn health(&self) -> Option<Health> {
        Some(Self::health(self))
    }
}

impl<T: Scalar> Follow for Augmented<T> {
    fn set_usual(&mut self, usual: f64) {
        Self::set_usual(self, usual);
    }

    fn take(&mut self, sample: &Sample) -> Result<(), uav::Error> {
        Self::take(self, &sized(sample)).map(drop)
    }

    fn estimate(&self) -> SVector<f64, 4> {
        self.filter().estimate().fixed_rows::<4>(0).into()
    }

    fn health(&self) -> Option<Health> {
        Some(Self::health(self))
    }
}

/// An observer whose gain is computed once the usual interval is known.
#[derive(Debug)]
struct Observer<T: Scalar, const P: usize> {
    model: Model,
    outputs: Vec<usize>,
    c: SMatrix<f64, P, 4>,
    poles: Poles,
    usual: f64,
    running: Option<Box<FlightObserver<T, P, KEPT>>>,
    before: Option<uav::Sample<P>>,
}

impl<T: Scalar, const P: usize> Observer<T, P> {
    fn new(model: &Model, outputs: &[usize], options: &Options) -> Self {
        Self {
            model: model.clone(),
            outputs: outputs.to_vec(),
            c: rows(model, outputs),
            poles: options.poles,
            usual: 0.0,
            running: None,
            before: None,
        }
    }

    /// An observer for the usual interval, which begins at the previous sample.
    fn begin(&self) -> Result<Box<FlightObserver<T, P, KEPT>>, uav::Error> {
        let poles = discrete(self.poles, self.usual);
        let mut observer =
            Box::new(FlightObserver::new(&self.model.dynamics, &self.c, &poles, self.usual)?);
        if let Some(before) = &self.before {
            observer.take(before)?;
        }
        Ok(observer)
    }
}

impl<T: Scalar, const P: usize> Follow for Observer<T, P> {
    fn set_usual(&mut self, usual: f64) {
        (self.usual, self.running) = (usual, None);
    }

    fn take(&mut self, sample: &Sample) -> Result<(), uav::Error> {
        let sample = sized(&self.model.without_direct(sample, &self.outputs));
        if self.before.is_some() {
            let mut observer = match self.running.take() {
                Some(observer) => observer,
                None => self.begin()?,
            };
            let taken = observer.take(&sample);
            self.running = Some(observer);
            taken?;
        }
        self.before = Some(sample);
        Ok(())
    }

    fn estimate(&self) -> SVector<f64, 4> {
        self.running.as_ref().map_or_else(SVector::zeros, |observer| observer.estimate())
    }

    fn health(&self) -> Option<Health> {
        self.running.as_ref().map(|observer| observer.health())
    }
}
