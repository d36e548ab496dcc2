mod health;
mod measure;
mod time;

use crate::config::{bias_shape, size};
use crate::health::Counters;
use crate::link::Link;
use crate::mirror::{self, Mirror};
use crate::pace::Pace;
use crate::start::Start;
use crate::stillness::Stillness;
use crate::wheel_noise::LARGEST_SPEED;
use crate::{Anchor, Config, Error, InertialSample, OdometrySample, RangeSample, Report};
use heapless::Vec;
use kestirim_kalman::Gaussian;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// Tracker of a tag in the plane at a known height, with the anchors' common bias among the five states.
pub type PlaneTracker<T, const A: usize> = Tracker<T, 2, 5, A>;
/// Tracker of a tag in the plane at a known height, for calibrated anchors: four states.
pub type CalibratedPlaneTracker<T, const A: usize> = Tracker<T, 2, 4, A>;
/// Tracker of a tag in space, with the anchors' common bias among the seven states.
pub type SpaceTracker<T, const A: usize> = Tracker<T, 3, 7, A>;
/// Tracker of a tag in space, for calibrated anchors: six states.
pub type CalibratedSpaceTracker<T, const A: usize> = Tracker<T, 3, 6, A>;

/// Tracks position, velocity and optionally the common range bias of a tag, from single ranges of up to A anchors.
///
/// The states are D coordinates (m), their velocities (m/s) and, if N = 2 D + 1, the bias common to all ranges (m).
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tracker<T: Scalar, const D: usize, const N: usize, const A: usize> {
    pub(crate) config: Config<T>,
    pub(crate) links: Vec<Link<T>, A>,
    pub(crate) place: Place<T, D, N, A>,
    /// Time of the estimate, µs.
    pub(crate) time_us: u64,
    stillness: Stillness<T>,
    wheels: Option<OdometrySample<T>>,
    /// Time until which standstills are ignored, µs.
    doubted_until_us: u64,
    /// Whether the IMU or the wheels indicate a standstill at the estimate's time.
    stands: bool,
    pub(crate) heard: u8,
    pub(crate) pace: Pace,
    /// Anchors behind whose line or plane the tag may be as well.
    mirror: Option<Mirror<D>>,
    /// Anchors behind whose line or plane the tag may always be, as all anchors lie in it.
    pub(crate) flat: Option<Mirror<D>>,
    /// Standard deviation beyond which a position is given up, m.
    lost_sigma: T,
    /// Dependence of the common bias on the distance: a constant, and a slope, 1/m.
    pub(crate) bias_shape: [T; 2],
    counters: Counters<T>,
}

/// The estimate, or the search for one: never both, so that they share memory.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub(crate) enum Place<T: Scalar, const D: usize, const N: usize, const A: usize> {
    Known(Gaussian<T, N>),
    Sought(Start<T, D, A>),
}

/// Standard deviation beyond which a position is given up among the anchors of an office, m; scaled where they are
/// farther apart.
pub(crate) const LOST_SIGMA: f64 = 2.0;
/// Time without a sample after which a position is given up (µs).
pub(crate) const LOST_US: u64 = 60_000_000;
/// Largest age of a sample relative to the estimate, µs: the IMU's samples arrive at once, ranges after an exchange of
/// messages.
pub(crate) const LATE_US: u64 = 100_000;
/// Largest plausible acceleration of the carrier of a tag, m/s².
const LARGEST_ACCELERATION: f64 = 500.0;

impl<T: Scalar, const D: usize, const N: usize, const A: usize> Tracker<T, D, N, A> {
    /// Interval at which the estimate follows the IMU between ranges, µs.
    const INERTIAL_STEP_US: u64 = 100_000;
    /// Longest interval over which an acceleration is taken to last, µs: in a gap of the IMU it does not.
    const LONGEST_PUSH_US: u64 = 250_000;

    /// Creates a tracker for these anchors, before its first position.
    ///
    /// # Errors
    /// [`Error::TooManyAnchors`] or [`Error::NotFinite`].
    pub fn new(config: Config<T>, anchors: &[Anchor<T>]) -> Result<Self, Error> {
        const { assert!(N == 2 * D || N == 2 * D + 1, "positions, velocities and perhaps a bias") };
        const { assert!(A <= 1 << 16, "anchors are counted in 16 bits") };
        let size = size(anchors);
        let config = config.scaled(size);
        let mut links = Vec::new();
        for anchor in anchors {
            anchor.check()?;
            links.push(Link::new(*anchor, &config)).map_err(|_| Error::TooManyAnchors)?;
        }
        let flat = mirror::flat(&links, config.range_sigma);
        Ok(Self {
            config,
            links,
            place: Place::Sought(Start::new()),
            time_us: 0,
            stillness: Stillness::new(),
            wheels: None,
            doubted_until_us: 0,
            stands: false,
            heard: 0,
            pace: Pace::new(anchors.len()),
            mirror: None,
            flat,
            lost_sigma: size * T::from_f64(LOST_SIGMA),
            bias_shape: bias_shape(size),
            counters: Counters::new(),
        })
    }

    /// Position of the tag, m; `None` before the first one, or when it is lost.
    #[inline]
    pub fn position(&self) -> Option<SVector<T, D>> {
        let estimate = self.estimate()?;
        Some(SVector::from_fn(|axis, _| estimate.mean.as_array()[axis]))
    }

    /// Velocity of the tag, m/s; `None` without a position.
    #[inline]
    pub fn velocity(&self) -> Option<SVector<T, D>> {
        let estimate = self.estimate()?;
        Some(SVector::from_fn(|axis, _| estimate.mean.as_array()[D + axis]))
    }

    /// The other position that the ranges allow, m; `None` if they allow only one, as usual.
    ///
    /// Two anchors in the plane, or three in space, cannot distinguish the two sides of their line or plane. A tag
    /// that came near it while no other anchor was heard may have crossed it or turned back: the position is one of
    /// the two until the range of another anchor, or the room, decides. If all existing anchors are collinear or
    /// coplanar to within a decimetre, only [`Config::room`] can decide, and without it there are always two
    /// positions.
    pub fn mirror_image(&self) -> Option<SVector<T, D>> {
        Some(self.position()? - self.across_in_room()?)
    }

    /// Vector from the mirror image to the position, m; `None` without a mirror image inside the room.
    pub(crate) fn across_in_room(&self) -> Option<SVector<T, D>> {
        mirror::across_in_room(self.mirror.as_ref()?, &self.config, &self.links, &self.position()?)
    }

    /// Vector from the mirror image to the position, m, regardless of the room.
    pub(crate) fn across(&self) -> Option<SVector<T, D>> {
        mirror::across(self.mirror.as_ref()?, &self.links, &self.position()?)
    }

    /// Mean and covariance of all states; `None` without a position.
    #[inline]
    pub fn estimate(&self) -> Option<&Gaussian<T, N>> {
        match &self.place {
            Place::Known(estimate) => Some(estimate),
            Place::Sought(_) => None,
        }
    }

    /// The standard deviation presently attributed to an anchor's ranges, m; `None` if there is no such anchor.
    pub fn range_sigma(&self, anchor: usize) -> Option<T> {
        self.links.get(anchor).map(|link| link.noise.variance().sqrt())
    }

    /// Sets the height of the tag, m, for a position in two dimensions.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_height(&mut self, height: T) -> Result<(), Error> {
        if !height.is_finite() {
            return Err(Error::NotFinite);
        }
        self.config.height = height;
        Ok(())
    }

    /// Processes a range.
    ///
    /// # Errors
    /// Any [`Error`] but `TooManyAnchors`; the tracker is unchanged.
    #[inline]
    pub fn range(&mut self, sample: &RangeSample<T>) -> Result<Report<T>, Error> {
        let range = self.links.get(sample.anchor).ok_or(Error::NoSuchAnchor)?.admit(sample)?;
        if sample.time_us <= self.time_us {
            self.check_time(sample.time_us)?;
            return self.measure(sample, range, self.means());
        }
        let before = self.timed();
        let report = self
            .advance(sample.time_us, None)
            .and_then(|()| self.measure(sample, range, self.means()));
        if report.is_err() {
            self.restore(before);
        } else if usize::from(self.heard) == D && self.mirror.is_none() {
            self.look_behind();
        }
        report
    }

    /// Processes a sample of the IMU.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ImplausibleMotion`], [`Error::OutOfOrder`] or [`Error::Estimate`]; the tracker
    /// is unchanged.
    #[inline]
    pub fn inertial(&mut self, sample: &InertialSample<T, D>) -> Result<(), Error> {
        let numbers = sample.acceleration.iter().chain(sample.push.iter().flatten());
        for &number in numbers {
            plausible(number, LARGEST_ACCELERATION)?;
        }
        self.check_time(sample.time_us)?;
        let elapsed = sample.time_us.saturating_sub(self.time_us);
        let mut stillness = self.stillness;
        let push = sample.push.map_or(T::ZERO, |push| T::norm(&push));
        stillness.update(sample.time_us, &sample.acceleration, push);
        if sample.push.is_some() || elapsed >= Self::INERTIAL_STEP_US {
            let before = (self.timed(), self.stillness);
            self.stillness = stillness;
            let push = sample.push.filter(|_| elapsed <= Self::LONGEST_PUSH_US);
            let advanced = self.advance(sample.time_us, push);
            if advanced.is_err() {
                self.restore(before.0);
                self.stillness = before.1;
            }
            return advanced;
        }
        self.stillness = stillness;
        Ok(())
    }

    /// Processes a sample of the wheels.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ImplausibleMotion`], [`Error::OutOfOrder`] or [`Error::Estimate`]; the tracker
    /// is unchanged.
    #[inline]
    pub fn odometry(&mut self, sample: &OdometrySample<T>) -> Result<(), Error> {
        plausible_wheels(sample)?;
        self.check_time(sample.time_us)?;
        self.wheels = Some(*sample);
        Ok(())
    }

    /// Gives the position up, and starts to search for another one.
    pub(crate) fn give_up(&mut self) {
        self.place = Place::Sought(Start::new());
        self.mirror = None;
    }

    /// Whether a search for a position is in progress.
    pub(crate) fn is_begun(&self) -> bool {
        matches!(&self.place, Place::Sought(start) if start.is_on())
    }

    /// Whether there is a position.
    #[inline]
    pub(crate) fn is_located(&self) -> bool {
        matches!(self.place, Place::Known(_))
    }

    /// Whether enough anchors are heard to distinguish a common bias from a distance, and whether there are more
    /// ranges than unknowns.
    #[inline(always)]
    fn means(&self) -> [bool; 2] {
        [self.heard as usize >= D + 2, self.heard as usize > D]
    }

    #[inline]
    fn check_time(&self, time_us: u64) -> Result<(), Error> {
        let late = time_us < self.time_us && self.time_us - time_us > LATE_US;
        if late { Err(Error::OutOfOrder) } else { Ok(()) }
    }
}

/// Checks that the odometry is plausible.
#[inline]
pub(crate) fn plausible_wheels<T: Scalar>(sample: &OdometrySample<T>) -> Result<(), Error> {
    plausible(sample.speed, LARGEST_SPEED)?;
    plausible(sample.turn_rate, LARGEST_SPEED)
}

/// Checks that a number is finite and not too large.
#[inline]
fn plausible<T: Scalar>(number: T, largest: f64) -> Result<(), Error> {
    if number.abs() <= T::from_f64(largest) {
        return Ok(());
    }
    Err(if number.is_finite() { Error::ImplausibleMotion } else { Error::NotFinite })
}
