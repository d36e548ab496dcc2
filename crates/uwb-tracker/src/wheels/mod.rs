//! Tracking of a tag on a robot with wheels.

mod course;
mod drive;
pub(crate) mod state;

use self::course::{Course, decided, within};
use self::state::{COSINE, COUNT, SINE};
use crate::config::{common_sigmas, size};
use crate::health::{self, Common, Counters, Place, count_heard};
use crate::link::Link;
use crate::measurement::ProportionalRange;
use crate::mirror::{self, Mirror};
use crate::pace::Pace;
use crate::start::Start;
use crate::take_in::{Known, take_in};
use crate::tracker::{LATE_US, LOST_SIGMA, LOST_US, plausible_wheels};
use crate::{
    Anchor, Config, Error, Health, OdometrySample, Outcome, RangeSample, Report, wheel_noise,
};
use heapless::Vec;
use kestirim_kalman::Gaussian;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// Tracks a tag in the plane on a robot with wheel odometry, from single ranges of up to A anchors.
///
/// The wheels drive the prediction, the ranges correct it. Scale, gain and drift of the odometry are estimated, and so
/// is the heading, of which nothing need be known. Whether positive turns are to the left or to the right is found out
/// by following both hypotheses until the ranges have decided, or one of them has left the [`Config::room`]. Ranges
/// may have a common bias, and an excess proportional to the distance.
///
/// The eight states are the position (m), k cos θ and k sin θ with the wheels' scale k and the heading θ at which
/// their count began, the drift (rad in 100 s) and gain of the turns, the bias of all ranges (m) and their excess in
/// 10 m (m).
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WheelTracker<T: Scalar, const A: usize> {
    config: Config<T>,
    links: Vec<Link<T>, A>,
    /// The anchors that define the line in which all lie, if they do.
    flat: Option<Mirror<2>>,
    /// Two courses while the sign of the turns is undecided; none without a position.
    courses: [Option<Course<T>>; 2],
    /// Time of the estimate, µs.
    time_us: u64,
    wheels: Option<OdometrySample<T>>,
    heard: u8,
    pace: Pace,
    /// Size of the anchors' area relative to an office.
    size: T,
    counters: Counters<T>,
    /// Average NIS of about the last five ranges, of which those that are too long count as one at most.
    too_short: T,
    start: Start<T, 2, A>,
}

/// Average of `too_short` above which the course is wrong, and the estimate begins anew. With few ranges, both courses may lead off
/// while the heading is hardly known. A wrong position makes some ranges seem too short; an obstacle never does.
const TOO_SHORT: f64 = 3.0;
/// Weight of a range in it, and the largest NIS that counts: one range that is wrong is not enough.
const SHARE_OF_ONE: f64 = 0.2;
const MOST_OF_ONE: f64 = 10.0;
/// Mean NIS of ranges above which the wheels are assumed to slip, or not to be this robot's; below it, their noise
/// grows with it.
const NIS_OF_SLIP: f64 = 4.0;
/// Smallest scale of wheels for which a heading is defined.
const LEAST_SCALE: f64 = 0.1;

impl<T: Scalar, const A: usize> WheelTracker<T, A> {
    /// Creates a tracker for these anchors, before its first position.
    ///
    /// # Errors
    /// [`Error::TooManyAnchors`] or [`Error::NotFinite`].
    pub fn new(config: Config<T>, anchors: &[Anchor<T>]) -> Result<Self, Error> {
        let size = size(anchors);
        // The excess that grows with the distance is a state here, not a constant error.
        let (learning, bias_sigma) = (config.learning, config.bias_sigma);
        let config = Config { learning, bias_sigma, ..config.scaled(size) };
        let mut links = Vec::new();
        for anchor in anchors {
            anchor.check()?;
            links.push(Link::new(*anchor, &config)).map_err(|_| Error::TooManyAnchors)?;
        }
        let flat = mirror::flat(&links, config.range_sigma);
        Ok(Self {
            config,
            links,
            flat,
            courses: [None; 2],
            time_us: 0,
            wheels: None,
            heard: 0,
            pace: Pace::new(anchors.len()),
            size,
            counters: Counters::new(),
            too_short: T::ONE,
            start: Start::new(),
        })
    }

    /// Position of the tag, m; `None` before the first one, or when it is lost.
    #[inline]
    pub fn position(&self) -> Option<SVector<T, 2>> {
        let mean = self.estimate()?.mean;
        Some(SVector::from_fn(|axis, _| mean.as_array()[axis]))
    }

    /// Mean and covariance of all states; `None` without a position.
    #[inline]
    pub fn estimate(&self) -> Option<&Gaussian<T, COUNT>> {
        self.courses.get(self.best())?.as_ref().map(|course| &course.estimate)
    }

    /// The factor to be applied to the wheels' distances (its sign is part of the heading); `None` before it is known.
    pub fn scale(&self) -> Option<T> {
        let mean = self.estimate()?.mean;
        let scale = mean.as_array()[COSINE].hypot(mean.as_array()[SINE]);
        Some(scale).filter(|&scale| scale > T::from_f64(LEAST_SCALE))
    }

    /// Health of the tracker at `time_us`.
    pub fn health(&self, time_us: u64) -> Health<T> {
        let wheels = self.fresh_wheels(time_us);
        let stands =
            |wheels: &OdometrySample<T>| wheels.speed == T::ZERO && wheels.turn_rate == T::ZERO;
        let place = self.later(time_us).and_then(|estimate| {
            // In the room's metres; if the wheels were not heard lately, with their last speed.
            let counted = self.wheels.map_or(T::ZERO, |wheels| wheels.speed);
            let state = estimate.mean.as_array();
            let speed = counted * state[COSINE].hypot(state[SINE]);
            Some(Place {
                position: self.position()?,
                variance: estimate.covariance.get(0, 0)? + estimate.covariance.get(1, 1)?,
                speed_squared: speed * speed,
                mirror: self.across_in_room().map(|across| T::norm(across.as_array())),
                common: Common::NONE,
            })
        });
        let still = wheels.is_some_and(stands);
        let (of, heard) = ((&self.counters, &self.config), (&*self.links, &self.pace));
        health::health(of, heard, place, time_us, still)
    }

    /// The estimate predicted to `time_us` without another sample; `None` if it has become useless by then.
    fn later(&self, time_us: u64) -> Option<Gaussian<T, COUNT>> {
        let mut course = (*self.courses.get(self.best())?)?;
        let elapsed = time_us.saturating_sub(self.time_us);
        if elapsed == 0 {
            return Some(course.estimate);
        }
        let last = self.wheels.map_or(T::ZERO, |wheels| wheels.speed);
        if elapsed > LOST_US || course.drift(T::from_micro(elapsed as i32), last).is_err() {
            return None;
        }
        (!self.is_lost(&course)).then_some(course.estimate)
    }

    /// Whether a course no longer says where the tag is.
    fn is_lost(&self, course: &Course<T>) -> bool {
        let most = self.size * T::from_f64(LOST_SIGMA);
        let most = most * most;
        course.estimate.covariance.variances().iter().take(2).any(|&variance| variance > most)
    }

    /// Vector from the mirror image behind the line of all anchors to the position, m; `None` unless they lie in one line and the
    /// room has both sides.
    fn across_in_room(&self) -> Option<SVector<T, 2>> {
        mirror::across_in_room(self.flat.as_ref()?, &self.config, &self.links, &self.position()?)
    }

    /// Sets the tag's height, m.
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

    /// Processes a sample of the wheels: their motion since the previous one.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ImplausibleMotion`], [`Error::OutOfOrder`] or [`Error::Estimate`]; the tracker
    /// is unchanged.
    pub fn odometry(&mut self, sample: &OdometrySample<T>) -> Result<(), Error> {
        plausible_wheels(sample)?;
        self.check_time(sample.time_us)?;
        let before = self.wheels.replace(*sample);
        let advanced = self.advance(sample.time_us);
        if advanced.is_err() {
            self.wheels = before;
        }
        advanced
    }

    /// Processes a range.
    ///
    /// # Errors
    /// Any [`Error`] but `TooManyAnchors`; the tracker is unchanged.
    pub fn range(&mut self, sample: &RangeSample<T>) -> Result<Report<T>, Error> {
        let link = self.links.get(sample.anchor).ok_or(Error::NoSuchAnchor)?;
        let range = link.admit(sample)?;
        self.check_time(sample.time_us)?;
        let before = (self.courses, self.time_us, self.heard);
        let report = self.advance(sample.time_us).and_then(|()| self.measure(sample, range));
        if report.is_err() {
            (self.courses, self.time_us, self.heard) = before;
        }
        report
    }

    #[inline]
    fn check_time(&self, time_us: u64) -> Result<(), Error> {
        let late = time_us < self.time_us && self.time_us - time_us > LATE_US;
        if late { Err(Error::OutOfOrder) } else { Ok(()) }
    }

    /// Index of the course that explains the ranges best.
    #[inline]
    fn best(&self) -> usize {
        match &self.courses {
            [Some(first), Some(second)] => usize::from(second.cost < first.cost),
            [None, Some(_)] => 1,
            _ => 0,
        }
    }

    #[inline]
    fn fresh_wheels(&self, time_us: u64) -> Option<&OdometrySample<T>> {
        let is_fresh = |wheels: &&OdometrySample<T>| {
            time_us.saturating_sub(wheels.time_us) <= wheel_noise::FRESH_US
        };
        self.wheels.as_ref().filter(is_fresh)
    }

    /// Predicts all courses to `time_us`; gives the position up if it has become useless.
    fn advance(&mut self, time_us: u64) -> Result<(), Error> {
        let elapsed = time_us.saturating_sub(self.time_us);
        if elapsed == 0 {
            return Ok(());
        }
        let interval = T::from_micro(elapsed.min(LOST_US) as i32);
        let believed = self.counters.nis < T::from_f64(NIS_OF_SLIP);
        // A sample says nothing about a silence that was longer than it stays fresh.
        let is_short = elapsed <= wheel_noise::FRESH_US;
        let wheels = self.fresh_wheels(time_us).filter(|_| believed && is_short);
        let last = self.wheels.map_or(T::ZERO, |wheels| wheels.speed);
        let doubt = self.counters.nis.max(T::ONE);
        let mut courses = self.courses;
        for course in courses.iter_mut().flatten() {
            match wheels {
                Some(wheels) => course.drive(interval, wheels, doubt)?,
                None => course.drift(interval, last)?,
            }
        }
        let given_up =
            elapsed > LOST_US || courses.iter().flatten().any(|course| self.is_lost(course));
        self.courses = if given_up { [None; 2] } else { courses };
        self.time_us = time_us;
        self.heard = count_heard(&self.links, &self.pace, time_us);
        Ok(())
    }

    /// Updates the courses with a range at the estimate's own time.
    fn measure(&mut self, sample: &RangeSample<T>, range: T) -> Result<Report<T>, Error> {
        let best = self.best();
        let link = self.links.get_mut(sample.anchor).ok_or(Error::NoSuchAnchor)?;
        let place = link.anchor.position;
        let observation =
            ProportionalRange { measured: range, anchor: &place, height: self.config.height };
        let known = Known { is_redundant: self.heard > 2, is_still: false };
        let (blocked, heard) = (link.is_blocked, self.heard);
        let agree = || self.counters.others_agree(blocked, heard, 2);
        let (mut courses, mut learning) = (self.courses, *link);
        let mut result = None;
        for (index, course) in courses.iter_mut().enumerate() {
            let Some(course) = course else { continue };
            // The anchor's noise is learnt from the better course alone.
            let mut other = *link;
            let link = if index == best { &mut learning } else { &mut other };
            let (outcome, seen) =
                take_in(&mut course.estimate, link, &observation, &self.config, known, agree)?;
            course.charge(&seen, link.gate.gamma());
            if index == best {
                result = Some((outcome, seen));
            }
        }
        let Some((outcome, seen)) = result else {
            return Ok(self.collect(sample, range));
        };
        *link = learning;
        link.hear(sample.time_us, range);
        self.courses = decided(courses);
        if let Some(room) = &self.config.room {
            self.courses = within(self.courses, room);
        }
        self.pace.hear(sample.time_us);
        if outcome != Outcome::Rejected {
            self.counters.take(seen.nis);
        } else if self.counters.reject(self.heard.max(2), learning.is_blocked) {
            self.courses = [None; 2];
        }
        let most = if seen.innovation > T::ZERO { T::ONE } else { T::from_f64(MOST_OF_ONE) };
        self.too_short += (seen.nis.min(most) - self.too_short) * T::from_f64(SHARE_OF_ONE);
        // With two anchors it could not begin anew.
        if self.heard > 2 && self.too_short > T::from_f64(TOO_SHORT) {
            self.courses = [None; 2];
        }
        Ok(Report { outcome, innovation: Some(seen) })
    }

    /// Stores a range for a first position, and determines one if possible.
    #[inline(never)] // Rare, and large.
    fn collect(&mut self, sample: &RangeSample<T>, range: T) -> Report<T> {
        let fresh_us = self.pace.fresh_us();
        let mut again = false;
        if let Some(link) = self.links.get_mut(sample.anchor) {
            again = link.fresh(self.time_us, fresh_us).is_some();
            link.hear(sample.time_us, range);
        }
        again &= self.pace.collect(sample.time_us, sample.anchor);
        let started = self.begin(again);
        let outcome = if started { Outcome::Started } else { Outcome::Collected };
        Report { outcome, innovation: None }
    }

    fn begin(&mut self, again: bool) -> bool {
        let heard = count_heard(&self.links, &self.pace, self.time_us);
        let may = again || usize::from(heard) >= self.links.len();
        let (now, leisure) = ((self.time_us, self.pace.fresh_us()), self.pace.leisure());
        let Some(begun) = self.start.go_on::<5>(&self.config, &self.links, now, leisure, may)
        else {
            return false;
        };
        let biases = common_sigmas(self.config.common_bias_sigma / self.size, self.size);
        let course = |gain| Some(Course::begun(&begun.estimate, biases, gain));
        // It applies to the time of its ranges: the next sample predicts it further.
        (self.courses, self.time_us) = ([course(T::ONE), course(-T::ONE)], begun.time_us);
        for link in &mut self.links {
            *link = link.begun(&self.config);
        }
        self.heard = heard;
        self.counters.begun();
        self.too_short = T::ONE;
        true
    }
}

#[cfg(test)]
mod tests;
