//! The trackers behind one interface, whatever number type they use.

mod each_epoch;
mod elsewhere;
mod listening;
mod published;
mod recursive;
mod wheeled;

use std::fmt::Debug;

use kestirim_adaptive_kalman::Learning;
use kestirim_kalman::{Covariance, Innovation};
use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_tracker::{Config, EpochMethod, Health, Outcome, RangeSample, Report};
use nalgebra::SVector;

use self::each_epoch::EachEpoch;
use self::elsewhere::Elsewhere;
use self::listening::Listening;
use self::published::Published;
pub use self::published::{Beginning, Noise};
use self::recursive::Recursive;
use self::wheeled::Wheeled;
use super::{Dimensions, Error, Event, Range, Setup, TrackerKind};
use crate::{Number, ScalarKind};

/// A tracker of a tag.
pub trait Follow: Debug {
    /// Processes an event, at a time in µs since the recording began. An event that the tracker has no use for is
    /// accepted and changes nothing.
    fn take(&mut self, time_us: u64, event: &Event) -> Reception;

    /// The position of the tag, m; in two dimensions, the height is the one that was set.
    fn position(&self) -> Option<[f64; 3]>;

    /// Variance of x, covariance, and variance of y, m², if the tracker knows them.
    fn spread(&self) -> Option<[f64; 3]> {
        None
    }

    /// Variance of z, m², if the tracker estimates it.
    fn height_variance(&self) -> Option<f64> {
        None
    }

    /// The vector from the position to the other place that the ranges allow, m, if the tracker knows it; `None` if
    /// they allow only one.
    fn mirror(&self) -> Option<[f64; 3]> {
        None
    }

    /// The doubts about the current position, if the tracker knows them.
    fn health(&self) -> kestirim_health::Health {
        kestirim_health::Health::GOOD
    }

    /// The snapshot of everything that it needs to continue elsewhere, to the bit; `None` if it cannot be stored.
    fn snapshot(&self) -> Option<Vec<u8>> {
        None
    }

    /// Continues from a snapshot; `None`, and no change, if that is not one of such a tracker.
    fn restore(&mut self, _snapshot: &[u8]) -> Option<()> {
        None
    }
}

/// The outcome of a measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reception {
    /// Whether it was accepted.
    pub taken: bool,
    /// The innovation of a range (m), its variance and NIS, if the tracker weighs ranges one by one.
    pub innovation: Option<Innovation<f64>>,
}

impl Reception {
    /// The outcome for a tracker that does not weigh measurements.
    pub const fn unweighed(taken: bool) -> Self {
        Self { taken, innovation: None }
    }

    /// The outcome of a range that was weighed individually, or rejected.
    fn of_range<T: Scalar, E>(answer: &Result<Report<T>, E>) -> Self {
        let Ok(report) = answer else { return Self::unweighed(false) };
        let innovation = report.innovation.map(|seen| Innovation {
            innovation: seen.innovation.to_f64(),
            variance: seen.variance.to_f64(),
            nis: seen.nis.to_f64(),
        });
        Self { taken: report.outcome != Outcome::Rejected, innovation }
    }

    /// The normalised innovation squared.
    pub fn nis(&self) -> Option<f64> {
        Some(self.innovation?.nis)
    }
}

/// Converts a range to the tracker's type.
fn sample<T: Scalar>(time_us: u64, range: &Range) -> RangeSample<T> {
    RangeSample { time_us, anchor: range.anchor, range: T::from_f64(range.metres) }
}

/// Builds the chosen tracker.
///
/// # Errors
/// [`Error`] if the anchors or numbers are unsuitable.
pub fn build(setup: &Setup) -> Result<Box<dyn Follow>, Error> {
    let Some(origin) = elsewhere::origin(setup) else { return build_here(setup) };
    let tracker = build_here(&elsewhere::about(setup, origin))?;
    Ok(Box::new(Elsewhere { tracker, origin }))
}

fn build_here(setup: &Setup) -> Result<Box<dyn Follow>, Error> {
    match setup.scalar {
        ScalarKind::F32 => with_scalar::<f32>(setup),
        ScalarKind::F64 => with_scalar::<f64>(setup),
        ScalarKind::Fixed => with_scalar::<Q12_20>(setup),
    }
}

fn with_scalar<T: Number>(setup: &Setup) -> Result<Box<dyn Follow>, Error> {
    match setup.dimensions {
        Dimensions::Two => in_dimensions::<T, 2, 4, 5>(setup),
        Dimensions::Three => in_dimensions::<T, 3, 6, 7>(setup),
    }
}

fn in_dimensions<T: Number, const D: usize, const N: usize, const WITH_BIAS: usize>(
    setup: &Setup,
) -> Result<Box<dyn Follow>, Error> {
    let (height, tuning) = (T::from_f64(setup.height_m), &setup.tuning);
    let plain = tuning.of_any(Config::plain(height));
    Ok(match setup.tracker {
        TrackerKind::Lsq => Box::new(EachEpoch::<T, D>::new(setup, EpochMethod::Trilateration)?),
        TrackerKind::Nls => Box::new(EachEpoch::<T, D>::new(setup, EpochMethod::LeastSquares)?),
        TrackerKind::Ekf => Box::new(Recursive::<T, D, N>::new(setup, plain)?),
        TrackerKind::Aekf => {
            let [forgetting, least, most] = TrackerKind::AEKF_LEARNING.map(T::from_f64);
            let learning = Learning::new(forgetting, least, most).ok();
            Box::new(Recursive::<T, D, N>::new(setup, Config { learning, ..plain })?)
        }
        TrackerKind::AekfPublished => Published::<T, D, N>::boxed(setup, Beginning::HONEST)?,
        TrackerKind::Default => {
            let is_calibrated = setup.biases.is_some();
            let config = if is_calibrated { Config::calibrated } else { Config::uncalibrated };
            let config = tuning.of_the_robust(config(height));
            let ranges: Box<dyn Follow> = if setup.is_wheeled() {
                Box::new(Wheeled::<T>::new(setup, config)?)
            } else if is_calibrated {
                Box::new(Recursive::<T, D, N>::new(setup, config)?)
            } else {
                Box::new(Recursive::<T, D, WITH_BIAS>::new(setup, config)?)
            };
            Box::new(Listening::<T, D, WITH_BIAS>::beside(ranges, setup, config)?)
        }
    })
}

/// Builds the default tracker in the plane and double precision with changed constants, to study their effect.
///
/// # Errors
/// Those of [`build`].
pub fn build_changed(
    setup: &Setup,
    change: impl FnOnce(&mut Config<f64>),
) -> Result<Box<dyn Follow>, Error> {
    if setup.biases.is_some() {
        let mut config = Config::calibrated(setup.height_m);
        change(&mut config);
        return Ok(Box::new(Recursive::<f64, 2, 4>::new(setup, config)?));
    }
    let mut config = Config::uncalibrated(setup.height_m);
    change(&mut config);
    Ok(Box::new(Recursive::<f64, 2, 5>::new(setup, config)?))
}

/// Builds the paper's filter in the plane, with a given start.
///
/// # Errors
/// Those of [`build`].
pub fn build_published(setup: &Setup, beginning: Beginning) -> Result<Box<dyn Follow>, Error> {
    match setup.scalar {
        ScalarKind::F32 => Published::<f32, 2, 4>::boxed(setup, beginning),
        ScalarKind::F64 => Published::<f64, 2, 4>::boxed(setup, beginning),
        ScalarKind::Fixed => Published::<Q12_20, 2, 4>::boxed(setup, beginning),
    }
}

/// Converts a position in two or three dimensions, m.
fn place<T: Scalar, const D: usize>(position: &SVector<T, D>, height_m: f64) -> Option<[f64; 3]> {
    let coordinate = |axis| position.get(axis).map(|coordinate: &T| coordinate.to_f64());
    Some([coordinate(0)?, coordinate(1)?, coordinate(2).unwrap_or(height_m)])
}

/// Variance of x, covariance and variance of y: those of the first two states of any filter.
fn of_the_plane<T: Scalar, const N: usize>(covariance: &Covariance<T, N>) -> Option<[f64; 3]> {
    let of = |i, j| covariance.get(i, j).map(T::to_f64);
    Some([of(0, 0)?, of(0, 1)?, of(1, 1)?])
}

/// Variance of x, covariance and variance of y, plus the variance that the anchors' constant errors add to each axis.
fn with_bias<T: Scalar, const N: usize>(
    covariance: &Covariance<T, N>,
    bias: f64,
) -> Option<[f64; 3]> {
    let [xx, xy, yy] = of_the_plane(covariance)?;
    Some([xx + bias, xy, yy + bias])
}

/// The variance that the anchors' constant errors add to each axis, m²: equal in all directions.
fn bias_variance<T: Scalar>(health: &Health<T>, dimensions: usize) -> f64 {
    health.bias_sigma.to_f64().powi(2) / dimensions as f64
}
