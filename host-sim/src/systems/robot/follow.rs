//! The trackers behind one face, whatever they compute in.

use kestirim_adaptive_kalman::Learning;
use kestirim_kalman::Covariance;
use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_tracker::{
    Anchor, Config, EpochMethod, InertialSample, OdometrySample, Outcome, RangeSample, Tracker,
};
use nalgebra::SVector;

use super::anchors::MOST;
use super::each_epoch::EachEpoch;
use super::motion::{Inertial, Wheels};
use super::options::{Dimensions, Setup, TrackerKind};
use super::published::{Beginning, Published};
use super::tuning::Tuning;
use crate::Error;
use crate::system::ScalarKind;

/// Something that follows a tag. Times are µs since the recording began.
pub trait Follow {
    /// Sets the tag's height, m.
    fn set_height(&mut self, height_m: f64);
    /// Takes in a range, m, and says what became of it.
    fn range(&mut self, time_us: u64, anchor: usize, range_m: f64) -> Reception;
    /// Takes in a sample of the IMU.
    fn inertial(&mut self, time_us: u64, sample: &Inertial);
    /// Takes in a sample of the wheels.
    fn wheels(&mut self, time_us: u64, sample: &Wheels);
    /// All ranges of this time have been given.
    fn end_epoch(&mut self, time_us: u64);
    /// Where the tag is, m; its height is given back as it was set in two dimensions.
    fn position(&self) -> Option<[f64; 3]>;
    /// Variance of x, covariance, and variance of y, m², of a tracker that knows them.
    fn spread(&self) -> Option<[f64; 3]> {
        None
    }
}

/// What became of a range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reception {
    /// Whether it made a difference.
    pub taken: bool,
    /// Its normalised innovation squared, from a tracker that weighs ranges one by one.
    pub nis: Option<f64>,
}

impl Reception {
    /// Of a tracker that weighs nothing.
    pub const fn unweighed(taken: bool) -> Self {
        Self { taken, nis: None }
    }
}

/// Builds what was chosen.
///
/// # Errors
/// [`Error::Usage`] if these anchors or numbers will not do.
pub fn build(setup: &Setup) -> Result<Box<dyn Follow>, Error> {
    build_tuned(setup, None)
}

/// The same with other constants.
///
/// # Errors
/// As [`build`].
pub fn build_tuned(setup: &Setup, tuning: Option<&Tuning>) -> Result<Box<dyn Follow>, Error> {
    match setup.scalar {
        ScalarKind::F32 => with_scalar::<f32>(setup, tuning),
        ScalarKind::F64 => with_scalar::<f64>(setup, tuning),
        ScalarKind::Fixed => with_scalar::<Q12_20>(setup, tuning),
    }
}

fn with_scalar<T: Scalar>(
    setup: &Setup,
    tuning: Option<&Tuning>,
) -> Result<Box<dyn Follow>, Error> {
    match setup.dimensions {
        Dimensions::Two => in_dimensions::<T, 2, 4, 5>(setup, tuning),
        Dimensions::Three => in_dimensions::<T, 3, 6, 7>(setup, tuning),
    }
}

fn in_dimensions<T: Scalar, const D: usize, const N: usize, const WITH_BIAS: usize>(
    setup: &Setup,
    tuning: Option<&Tuning>,
) -> Result<Box<dyn Follow>, Error> {
    let height = T::from_f64(setup.height_m);
    let plain = |config| tuning.map_or(config, |tuning| tuning.of_any(config));
    let robust = |config| tuning.map_or(config, |tuning| tuning.of_the_robust(config));
    Ok(match setup.tracker {
        TrackerKind::Lsq => Box::new(EachEpoch::<T, D>::new(setup, EpochMethod::Trilateration)?),
        TrackerKind::Nls => Box::new(EachEpoch::<T, D>::new(setup, EpochMethod::LeastSquares)?),
        TrackerKind::Ekf => {
            Box::new(Recursive::<T, D, N>::new(setup, plain(Config::plain(height)))?)
        }
        TrackerKind::Aekf => {
            let limits = [0.99, 0.0025, 9.0].map(T::from_f64);
            let learning = Learning::new(limits[0], limits[1], limits[2]).ok();
            let config = Config { learning, ..Config::plain(height) };
            Box::new(Recursive::<T, D, N>::new(setup, plain(config))?)
        }
        TrackerKind::AekfPrinted => Published::<T, D, N>::boxed(setup, Beginning::HONEST)?,
        TrackerKind::Default if setup.biases.is_some() => {
            Box::new(Recursive::<T, D, N>::new(setup, robust(Config::calibrated(height)))?)
        }
        TrackerKind::Default => {
            let config = robust(Config::uncalibrated(height));
            Box::new(Recursive::<T, D, WITH_BIAS>::new(setup, config)?)
        }
    })
}

/// The default tracker in the plane and double precision, with its constants changed: to see what they do.
///
/// # Errors
/// As [`build`].
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

/// The paper's filter in the plane, begun as one likes.
///
/// # Errors
/// As [`build`].
pub fn build_published(setup: &Setup, beginning: Beginning) -> Result<Box<dyn Follow>, Error> {
    match setup.scalar {
        ScalarKind::F32 => Published::<f32, 2, 4>::boxed(setup, beginning),
        ScalarKind::F64 => Published::<f64, 2, 4>::boxed(setup, beginning),
        ScalarKind::Fixed => Published::<Q12_20, 2, 4>::boxed(setup, beginning),
    }
}

/// `kestirim_uwb_tracker`.
struct Recursive<T: Scalar, const D: usize, const N: usize> {
    tracker: Tracker<T, D, N, MOST>,
    height_m: f64,
    /// Whether the prediction is driven by the IMU, as the paper's is.
    pushed: bool,
}

impl<T: Scalar, const D: usize, const N: usize> Recursive<T, D, N> {
    fn new(setup: &Setup, config: Config<T>) -> Result<Self, Error> {
        let config = Config { room: setup.room(), ..config };
        let tracker = Tracker::new(config, &anchors(setup)).map_err(refused)?;
        let pushed = matches!(setup.tracker, TrackerKind::Ekf | TrackerKind::Aekf);
        Ok(Self { tracker, height_m: setup.height_m, pushed })
    }
}

impl<T: Scalar, const D: usize, const N: usize> Follow for Recursive<T, D, N> {
    fn set_height(&mut self, height_m: f64) {
        if self.tracker.set_height(T::from_f64(height_m)).is_ok() {
            self.height_m = height_m;
        }
    }

    fn range(&mut self, time_us: u64, anchor: usize, range_m: f64) -> Reception {
        let sample = RangeSample { time_us, anchor, range: T::from_f64(range_m) };
        match self.tracker.range(&sample) {
            Ok(report) => Reception {
                taken: report.outcome != Outcome::Rejected,
                nis: report.innovation.map(|innovation| innovation.nis.to_f64()),
            },
            Err(_) => Reception::unweighed(false),
        }
    }

    fn inertial(&mut self, time_us: u64, sample: &Inertial) {
        let push = sample.push.filter(|_| self.pushed);
        let sample = InertialSample {
            time_us,
            acceleration: SVector::from(sample.acceleration.map(T::from_f64)),
            push: push.map(|push| std::array::from_fn(|axis| T::from_f64(push[axis]))),
        };
        // A sample that is refused is one that the filter does without.
        let _ = self.tracker.inertial(&sample);
    }

    fn wheels(&mut self, time_us: u64, sample: &Wheels) {
        let speed = T::from_f64(sample.speed);
        let turn_rate = T::from_f64(sample.turn_rate);
        let _ = self.tracker.odometry(&OdometrySample { time_us, speed, turn_rate });
    }

    fn end_epoch(&mut self, _: u64) {}

    fn position(&self) -> Option<[f64; 3]> {
        place(&self.tracker.position()?, self.height_m)
    }

    fn spread(&self) -> Option<[f64; 3]> {
        self.tracker.estimate().and_then(|estimate| of_the_plane(&estimate.covariance))
    }
}

/// The anchors in another number type.
pub(super) fn anchors<T: Scalar>(setup: &Setup) -> Vec<Anchor<T>> {
    let places = setup.anchors.iter().enumerate();
    let anchor = |(index, place): (usize, &[f64; 3])| Anchor {
        position: SVector::from(place.map(T::from_f64)),
        bias: T::from_f64(setup.bias(index)),
    };
    places.map(anchor).collect()
}

/// A tracker that cannot be made.
pub(super) fn refused(error: kestirim_uwb_tracker::Error) -> Error {
    Error::Usage(format!("these anchors cannot be used: {error}"))
}

/// A position in two or three dimensions, m.
pub(super) fn place<T: Scalar, const D: usize>(
    position: &SVector<T, D>,
    height_m: f64,
) -> Option<[f64; 3]> {
    let coordinate = |axis| position.get(axis).map(|coordinate: &T| coordinate.to_f64());
    Some([coordinate(0)?, coordinate(1)?, coordinate(2).unwrap_or(height_m)])
}

/// Variance of x, covariance and variance of y: of the first two states of any filter.
pub(super) fn of_the_plane<T: Scalar, const N: usize>(
    covariance: &Covariance<T, N>,
) -> Option<[f64; 3]> {
    let of = |i, j| covariance.get(i, j).map(T::to_f64);
    Some([of(0, 0)?, of(0, 1)?, of(1, 1)?])
}
