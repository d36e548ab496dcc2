//! The trackers of `kestirim-uwb-tracker` behind one face, whatever they compute in.

use kestirim_kalman::Covariance;
use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_ranging::Room;
use kestirim_uwb_tracker::{
    Anchor, Config, Error, InertialSample, OdometrySample, Outcome, RangeSample, Report, Tracker,
    WheelTracker,
};
use nalgebra::SVector;
use pyo3::{PyErr, PyResult};

use super::MOST;
use super::events::Moved;
use super::height::Found;
use crate::arrays::{ScalarKind, vector};
use crate::error::{KestirimError, refused};

/// Coordinates in the plane up to here are taken as they are, m: single precision is too coarse far from the origin.
const NEAR: f64 = 500.0;

/// What a tracker is built from.
#[derive(Clone)]
pub(super) struct Setup {
    pub(super) anchors: Vec<[f64; 3]>,
    /// What they measure too long, m, if they are calibrated.
    pub(super) biases: Option<Vec<f64>>,
    pub(super) height: f64,
    pub(super) room: Option<[f64; 4]>,
    pub(super) has_wheels: bool,
    pub(super) dim: usize,
    /// The height as the ranges tell it, if nobody says it.
    pub(super) found: Option<Found>,
}

impl Setup {
    pub(super) fn anchors<T: Scalar>(&self) -> Vec<Anchor<T>> {
        let of = |biases: Option<&Vec<f64>>, index| biases.and_then(|all| all.get(index).copied());
        let found = self.found.as_ref().map(|found| &found.biases);
        let anchor = |(index, place): (usize, &[f64; 3])| {
            let bias = of(self.biases.as_ref(), index).unwrap_or_default()
                + of(found, index).unwrap_or_default();
            Anchor { position: vector(place), bias: T::from_f64(bias) }
        };
        self.anchors.iter().enumerate().map(anchor).collect()
    }

    fn config<T: Scalar>(&self) -> Config<T> {
        let height = T::from_f64(self.height);
        let config = match self.biases {
            Some(_) => Config::calibrated(height),
            None => Config::uncalibrated(height),
        };
        let room = self.room.map(|corners| {
            let [x0, y0, x1, y1] = corners.map(T::from_f64);
            Room::plane(x0, y0, x1, y1)
        });
        Config { room, ..config }
    }

    /// The origin nearby, in whole metres, if the anchors are far from their own.
    fn origin(&self) -> Option<[f64; 2]> {
        let is_far = self.anchors.iter().any(|[x, y, _]| x.abs().max(y.abs()) > NEAR);
        let count = self.anchors.len() as f64;
        let mean =
            |axis: usize| self.anchors.iter().map(|anchor| anchor[axis]).sum::<f64>() / count;
        is_far.then(|| [0, 1].map(|axis| mean(axis).round()))
    }

    fn about(&self, [x, y]: [f64; 2]) -> Self {
        let mut near = self.clone();
        for anchor in &mut near.anchors {
            *anchor = [anchor[0] - x, anchor[1] - y, anchor[2]];
        }
        near.room = near.room.map(|[x0, y0, x1, y1]| [x0 - x, y0 - y, x1 - x, y1 - y]);
        near
    }
}

/// What became of a range: whether it was taken in, and its NIS if it was weighed.
pub(super) type Reception = (bool, f64);

/// Something that follows a tag; times in µs since the recording began.
pub(super) trait Tag {
    fn range(&mut self, time_us: u64, anchor: usize, metres: f64) -> Reception;
    fn moved(&mut self, time_us: u64, moved: Moved);
    fn set_height(&mut self, time_us: u64, metres: f64);
    /// All ranges of a time were given.
    fn end_epoch(&mut self, time_us: u64);
    fn position(&self) -> Option<[f64; 3]>;
    /// Variance of x, covariance, variance of y, m².
    fn spread(&self) -> Option<[f64; 3]>;
    fn height_variance(&self) -> Option<f64>;
}

/// Builds what fits the sensors.
pub(super) fn build(setup: &Setup, scalar: ScalarKind) -> PyResult<Box<dyn Tag>> {
    let Some(origin) = setup.origin() else { return build_here(setup, scalar) };
    let tag = build_here(&setup.about(origin), scalar)?;
    Ok(Box::new(Elsewhere { tag, origin }))
}

fn build_here(setup: &Setup, scalar: ScalarKind) -> PyResult<Box<dyn Tag>> {
    match scalar {
        ScalarKind::F32 => with_scalar::<f32>(setup),
        ScalarKind::F64 => with_scalar::<f64>(setup),
        ScalarKind::Fixed => with_scalar::<Q12_20>(setup),
    }
}

fn with_scalar<T: Scalar>(setup: &Setup) -> PyResult<Box<dyn Tag>> {
    let is_calibrated = setup.biases.is_some();
    Ok(match setup.dim {
        2 if setup.has_wheels => Box::new(Wheeled::<T>::new(setup)?),
        2 if is_calibrated => Box::new(Recursive::<T, 2, 4>::new(setup)?),
        2 => Box::new(Recursive::<T, 2, 5>::new(setup)?),
        3 if is_calibrated => Box::new(Recursive::<T, 3, 6>::new(setup)?),
        3 => Box::new(Recursive::<T, 3, 7>::new(setup)?),
        other => {
            return Err(KestirimError::new_err(format!("dim: expected 2 or 3, found {other}")));
        }
    })
}

pub(super) fn unusable(error: Error) -> PyErr {
    refused(format!("these anchors cannot be used: {error}"))
}

fn reception<T: Scalar>(answer: &Result<Report<T>, Error>) -> Reception {
    let Ok(report) = answer else { return (false, f64::NAN) };
    let nis = report.innovation.map_or(f64::NAN, |innovation| innovation.nis.to_f64());
    (report.outcome != Outcome::Rejected, nis)
}

fn place<T: Scalar, const D: usize>(position: &SVector<T, D>, height: f64) -> Option<[f64; 3]> {
    let coordinate = |axis| position.get(axis).map(|it: &T| it.to_f64());
    Some([coordinate(0)?, coordinate(1)?, coordinate(2).unwrap_or(height)])
}

fn of_the_plane<T: Scalar, const N: usize>(covariance: &Covariance<T, N>) -> Option<[f64; 3]> {
    let of = |i, j| covariance.get(i, j).map(T::to_f64);
    Some([of(0, 0)?, of(0, 1)?, of(1, 1)?])
}

fn rolled<T: Scalar>(time_us: u64, [speed, turn_rate]: [f64; 2]) -> OdometrySample<T> {
    OdometrySample { time_us, speed: T::from_f64(speed), turn_rate: T::from_f64(turn_rate) }
}

/// Takes in every measurement by itself.
struct Recursive<T: Scalar, const D: usize, const N: usize> {
    tracker: Tracker<T, D, N, MOST>,
    now_us: u64,
    height: f64,
}

impl<T: Scalar, const D: usize, const N: usize> Recursive<T, D, N> {
    fn new(setup: &Setup) -> PyResult<Self> {
        let tracker = Tracker::new(setup.config(), &setup.anchors()).map_err(unusable)?;
        Ok(Self { tracker, now_us: 0, height: setup.height })
    }

    /// What the anchors' constant errors add to the variance of each axis, m².
    fn bias_variance(&self) -> f64 {
        self.tracker.health(self.now_us).bias_sigma.to_f64().powi(2) / D as f64
    }
}

// What a tracker refuses leaves it as it was: as with a recording that is replayed, the next sample is taken.
impl<T: Scalar, const D: usize, const N: usize> Tag for Recursive<T, D, N> {
    fn range(&mut self, time_us: u64, anchor: usize, metres: f64) -> Reception {
        self.now_us = time_us;
        let range = T::from_f64(metres);
        reception(&self.tracker.range(&RangeSample { time_us, anchor, range }))
    }

    fn moved(&mut self, time_us: u64, moved: Moved) {
        self.now_us = time_us;
        let _ = match moved {
            Moved::Accelerated(accel) => {
                let acceleration = vector(&accel);
                self.tracker.inertial(&InertialSample { time_us, acceleration, push: None }).is_ok()
            }
            Moved::Rolled(wheels) => self.tracker.odometry(&rolled(time_us, wheels)).is_ok(),
        };
    }

    fn set_height(&mut self, time_us: u64, metres: f64) {
        self.now_us = time_us;
        if self.tracker.set_height(T::from_f64(metres)).is_ok() {
            self.height = metres;
        }
    }

    fn end_epoch(&mut self, time_us: u64) {
        self.now_us = time_us;
    }

    fn position(&self) -> Option<[f64; 3]> {
        place(&self.tracker.position()?, self.height)
    }

    fn spread(&self) -> Option<[f64; 3]> {
        let [xx, xy, yy] = of_the_plane(&self.tracker.estimate()?.covariance)?;
        let bias = self.bias_variance();
        Some([xx + bias, xy, yy + bias])
    }

    fn height_variance(&self) -> Option<f64> {
        let covariance = &self.tracker.estimate().filter(|_| D == 3)?.covariance;
        Some(covariance.get(2, 2)?.to_f64() + self.bias_variance())
    }
}

/// Is moved by the wheels, and takes in every range by itself.
struct Wheeled<T: Scalar> {
    tracker: WheelTracker<T, MOST>,
    now_us: u64,
    height: f64,
}

impl<T: Scalar> Wheeled<T> {
    fn new(setup: &Setup) -> PyResult<Self> {
        let tracker = WheelTracker::new(setup.config(), &setup.anchors()).map_err(unusable)?;
        Ok(Self { tracker, now_us: 0, height: setup.height })
    }
}

impl<T: Scalar> Tag for Wheeled<T> {
    fn range(&mut self, time_us: u64, anchor: usize, metres: f64) -> Reception {
        self.now_us = time_us;
        let range = T::from_f64(metres);
        reception(&self.tracker.range(&RangeSample { time_us, anchor, range }))
    }

    fn moved(&mut self, time_us: u64, moved: Moved) {
        self.now_us = time_us;
        if let Moved::Rolled(wheels) = moved {
            let _ = self.tracker.odometry(&rolled(time_us, wheels));
        }
    }

    fn set_height(&mut self, time_us: u64, metres: f64) {
        self.now_us = time_us;
        if self.tracker.set_height(T::from_f64(metres)).is_ok() {
            self.height = metres;
        }
    }

    fn end_epoch(&mut self, time_us: u64) {
        self.now_us = time_us;
    }

    fn position(&self) -> Option<[f64; 3]> {
        place(&self.tracker.position()?, self.height)
    }

    fn spread(&self) -> Option<[f64; 3]> {
        let [xx, xy, yy] = of_the_plane(&self.tracker.estimate()?.covariance)?;
        let bias = self.tracker.health(self.now_us).bias_sigma.to_f64().powi(2) / 2.0;
        Some([xx + bias, xy, yy + bias])
    }

    fn height_variance(&self) -> Option<f64> {
        None
    }
}

/// A tracker about an origin nearby.
struct Elsewhere {
    tag: Box<dyn Tag>,
    origin: [f64; 2],
}

impl Tag for Elsewhere {
    fn range(&mut self, time_us: u64, anchor: usize, metres: f64) -> Reception {
        self.tag.range(time_us, anchor, metres)
    }

    fn moved(&mut self, time_us: u64, moved: Moved) {
        self.tag.moved(time_us, moved);
    }

    fn set_height(&mut self, time_us: u64, metres: f64) {
        self.tag.set_height(time_us, metres);
    }

    fn end_epoch(&mut self, time_us: u64) {
        self.tag.end_epoch(time_us);
    }

    fn position(&self) -> Option<[f64; 3]> {
        let ([x, y, z], [x0, y0]) = (self.tag.position()?, self.origin);
        Some([x0 + x, y0 + y, z])
    }

    fn spread(&self) -> Option<[f64; 3]> {
        self.tag.spread()
    }

    fn height_variance(&self) -> Option<f64> {
        self.tag.height_variance()
    }
}
