use crate::health::Counters;
use crate::link::Link;
use crate::motion;
use crate::start::start;
use crate::stillness::Stillness;
use crate::{
    Anchor, Config, Error, Health, InertialSample, OdometrySample, Outcome, RangeSample, Report,
    State,
};
use heapless::Vec;
use kestirim_adaptive_kalman::learnt;
use kestirim_kalman::{Gaussian, Verdict, Weighed};
use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::{ExpectedRange, dilution_of_precision, expected_range};
use nalgebra::SVector;

/// A tag in the plane at a known height, with the anchors' common bias among the five states.
pub type PlaneTracker<T, const A: usize> = Tracker<T, 2, 5, A>;
/// A tag in the plane at a known height, for calibrated anchors: four states.
pub type CalibratedPlaneTracker<T, const A: usize> = Tracker<T, 2, 4, A>;
/// A tag in space, with the anchors' common bias among the seven states.
pub type SpaceTracker<T, const A: usize> = Tracker<T, 3, 7, A>;
/// A tag in space, for calibrated anchors: six states.
pub type CalibratedSpaceTracker<T, const A: usize> = Tracker<T, 3, 6, A>;

/// Position, velocity and perhaps common bias of a tag, from single ranges of up to A anchors.
///
/// The states are D coordinates (m), their velocities (m/s) and, if N = 2 D + 1, what all ranges are too
/// long by (m).
#[derive(Clone, Debug)]
pub struct Tracker<T: Scalar, const D: usize, const N: usize, const A: usize> {
    config: Config<T>,
    links: Vec<Link<T>, A>,
    estimate: Option<Gaussian<T, N>>,
    /// When the estimate holds.
    time_us: u64,
    stillness: Stillness<T>,
    wheels: Option<OdometrySample<T>>,
    /// Until then, what says that the tag stands is not believed.
    doubted_until_us: u64,
    heard: u8,
    counters: Counters<T>,
}

/// Estimate, its time, anchors heard, end of a doubt.
type Timed<T, const N: usize> = (Option<Gaussian<T, N>>, u64, u8, u64);

impl<T: Scalar, const D: usize, const N: usize, const A: usize> Tracker<T, D, N, A> {
    /// What no radio measures, m.
    const SHORTEST: f64 = -1.0;
    const LONGEST: f64 = 200.0;
    /// A sample may be so much older than the estimate (µs): the IMU's samples come at once, ranges
    /// after an exchange of messages.
    const LATE_US: u64 = 100_000;
    /// Between ranges, the estimate follows the IMU in steps of this (µs).
    const INERTIAL_STEP_US: u64 = 100_000;
    /// Odometry older than this says nothing about now (µs).
    const WHEELS_US: u64 = 500_000;
    /// A position this uncertain is none, m.
    const LOST_SIGMA: f64 = 2.0;
    /// Nor is one that nothing has been heard of for so long (µs).
    const LOST_US: u64 = 60_000_000;
    /// Ranges whose mean NIS is above this do not come from a tag that stands.
    const NIS_OF_MOTION: f64 = 4.0;
    /// For so long standing is doubted then (µs), …
    const DOUBT_US: u64 = 30_000_000;
    /// … and the velocity is as uncertain as at the start, (m/s)².
    const DOUBTED_VARIANCE: f64 = 0.25;
    /// A robot turning faster changes its direction between two ranges, rad/s.
    const TURNING: f64 = 0.3;

    /// A tracker for these anchors, which does not know yet where it is.
    ///
    /// # Errors
    /// [`Error::TooManyAnchors`] or [`Error::NotFinite`].
    pub fn new(config: Config<T>, anchors: &[Anchor<T>]) -> Result<Self, Error> {
        const { assert!(N == 2 * D || N == 2 * D + 1, "positions, velocities and perhaps a bias") };
        let mut links = Vec::new();
        for anchor in anchors {
            let numbers = anchor.position.iter().chain([&anchor.bias]);
            if !numbers.copied().all(T::is_finite) {
                return Err(Error::NotFinite);
            }
            links.push(Link::new(*anchor, &config)).map_err(|_| Error::TooManyAnchors)?;
        }
        Ok(Self {
            config,
            links,
            estimate: None,
            time_us: 0,
            stillness: Stillness::new(),
            wheels: None,
            doubted_until_us: 0,
            heard: 0,
            counters: Counters::new(),
        })
    }

    /// Where the tag is, m; none before the first position, or when it is lost.
    #[inline]
    pub fn position(&self) -> Option<SVector<T, D>> {
        let estimate = self.estimate.as_ref()?;
        Some(SVector::from_fn(|axis, _| estimate.mean.data.0[0][axis]))
    }

    /// How fast it moves, m/s.
    #[inline]
    pub fn velocity(&self) -> Option<SVector<T, D>> {
        let estimate = self.estimate.as_ref()?;
        Some(SVector::from_fn(|axis, _| estimate.mean.data.0[0][D + axis]))
    }

    /// Mean and covariance of all states.
    #[inline]
    pub fn estimate(&self) -> Option<&Gaussian<T, N>> {
        self.estimate.as_ref()
    }

    /// The standard deviation that is attributed to an anchor's ranges at present, m.
    pub fn range_sigma(&self, anchor: usize) -> Option<T> {
        self.links.get(anchor).map(|link| link.variance.sqrt())
    }

    /// Sets the tag's height in two dimensions, m.
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

    /// Takes in a range.
    ///
    /// # Errors
    /// Any [`Error`] but `TooManyAnchors`; the tracker is as it was.
    #[inline]
    pub fn range(&mut self, sample: &RangeSample<T>) -> Result<Report<T>, Error> {
        let range = self.check(sample)?;
        if sample.time_us <= self.time_us {
            self.check_time(sample.time_us)?;
            return self.measure(sample, range);
        }
        let before = self.timed();
        let report = self.advance(sample.time_us, None).and_then(|()| self.measure(sample, range));
        if report.is_err() {
            self.restore(before);
        }
        report
    }

    /// Takes in a sample of the IMU.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfOrder`] or [`Error::Estimate`]; the tracker is as it was.
    #[inline]
    pub fn inertial(&mut self, sample: &InertialSample<T, D>) -> Result<(), Error> {
        let numbers = sample.acceleration.iter().chain(sample.push.iter().flatten());
        if !numbers.copied().all(T::is_finite) {
            return Err(Error::NotFinite);
        }
        self.check_time(sample.time_us)?;
        let elapsed = sample.time_us.saturating_sub(self.time_us);
        let mut stillness = self.stillness;
        let push = sample.push.map_or(T::ZERO, |push| T::norm(&push));
        stillness.update(sample.time_us, &sample.acceleration, push);
        if sample.push.is_some() || elapsed >= Self::INERTIAL_STEP_US {
            let before = (self.timed(), self.stillness);
            self.stillness = stillness;
            let advanced = self.advance(sample.time_us, sample.push);
            if advanced.is_err() {
                self.restore(before.0);
                self.stillness = before.1;
            }
            return advanced;
        }
        self.stillness = stillness;
        Ok(())
    }

    /// Takes in a sample of the wheels.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfOrder`] or [`Error::Estimate`]; the tracker is as it was.
    #[inline]
    pub fn odometry(&mut self, sample: &OdometrySample<T>) -> Result<(), Error> {
        if !(sample.speed.is_finite() && sample.turn_rate.is_finite()) {
            return Err(Error::NotFinite);
        }
        self.check_time(sample.time_us)?;
        self.wheels = Some(*sample);
        Ok(())
    }

    /// How the tracker feels at `time_us`.
    pub fn health(&self, time_us: u64) -> Health<T> {
        let counters = &self.counters;
        let heard = self.count_heard(time_us);
        let position_sigma = self.estimate.as_ref().map(|estimate| {
            let variances = estimate.covariance.variances();
            variances.iter().take(D).fold(T::ZERO, |sum, &variance| sum + variance).sqrt()
        });
        Health {
            state: match (&self.estimate, counters.starts) {
                (None, 0) => State::Initialising,
                (None, _) => State::Lost,
                (Some(_), _) if heard == 0 => State::Coasting,
                (Some(_), _) => State::Tracking,
            },
            nis: counters.nis,
            taken: counters.taken,
            rejected: counters.rejected,
            restarts: counters.starts.saturating_sub(1),
            heard,
            dilution: self.dilution(time_us),
            position_sigma,
            still: self.is_still(time_us),
        }
    }

    /// The range freed of its bias, if it can be one.
    #[inline]
    fn check(&self, sample: &RangeSample<T>) -> Result<T, Error> {
        let link = self.links.get(sample.anchor).ok_or(Error::NoSuchAnchor)?;
        let plausible = T::from_f64(Self::SHORTEST)..=T::from_f64(Self::LONGEST);
        if !plausible.contains(&sample.range) {
            let finite = sample.range.is_finite();
            return Err(if finite { Error::ImplausibleRange } else { Error::NotFinite });
        }
        if sample.time_us < link.next_us() {
            let again = sample.time_us == link.next_us() - 1;
            return Err(if again { Error::Duplicate } else { Error::OutOfOrder });
        }
        Ok(sample.range - link.anchor.bias)
    }

    #[inline]
    fn check_time(&self, time_us: u64) -> Result<(), Error> {
        let late = time_us < self.time_us && self.time_us - time_us > Self::LATE_US;
        if late { Err(Error::OutOfOrder) } else { Ok(()) }
    }

    /// What [`Tracker::advance`] changes.
    #[inline]
    fn timed(&self) -> Timed<T, N> {
        (self.estimate, self.time_us, self.heard, self.doubted_until_us)
    }

    #[inline]
    fn restore(&mut self, before: Timed<T, N>) {
        (self.estimate, self.time_us, self.heard, self.doubted_until_us) = before;
    }

    /// Moves the estimate on to `time_us`; gives it up if it has become worthless.
    #[inline]
    fn advance(&mut self, time_us: u64, push: Option<[T; D]>) -> Result<(), Error> {
        let elapsed = time_us.saturating_sub(self.time_us);
        if elapsed == 0 {
            return Ok(());
        }
        if elapsed > Self::LOST_US {
            self.estimate = None;
        }
        if self.counters.nis > T::from_f64(Self::NIS_OF_MOTION) {
            self.doubt_standing();
        }
        if let Some(mut estimate) = self.estimate {
            let still = self.is_still(time_us) && motion::may_stand::<T, D, N>(&estimate);
            let interval = T::from_micro(elapsed.min(Self::LOST_US) as i32);
            motion::advance(&mut estimate, &self.config, interval, still, push)?;
            if still {
                motion::stand_still::<T, D, N>(&mut estimate)?;
            } else if let Some(wheels) = self.fresh_wheels(time_us)
                && wheels.turn_rate.abs() < T::from_f64(Self::TURNING)
            {
                motion::drive::<T, D, N>(&mut estimate, wheels.speed)?;
            }
            let variances = estimate.covariance.variances();
            let most = T::from_f64(Self::LOST_SIGMA * Self::LOST_SIGMA);
            let lost = variances.iter().take(D).any(|&variance| variance > most);
            self.estimate = if lost { None } else { Some(estimate) };
        }
        self.time_us = time_us;
        self.heard = self.count_heard(time_us);
        Ok(())
    }

    /// Takes in a range at the estimate's own time.
    #[inline(always)]
    fn measure(&mut self, sample: &RangeSample<T>, range: T) -> Result<Report<T>, Error> {
        let link = self.links.get_mut(sample.anchor).ok_or(Error::NoSuchAnchor)?;
        let Some(estimate) = &mut self.estimate else {
            return Ok(self.collect(sample, range));
        };
        let observes_bias = N > 2 * D && self.heard as usize >= D + 2;
        let (row, expected) =
            predicted_range::<T, D, N>(estimate, &self.config, &link.anchor, observes_bias);
        let row = row.get(..N - D).unwrap_or(&row);
        let weighed = estimate.weigh_entries(row, range - expected, link.variance)?;
        let seen = weighed.report();

        let mut gate = link.gate;
        let verdict =
            if self.config.gate.is_some() { gate.judge(&weighed) } else { Verdict::Admit };
        let outcome = match verdict {
            Verdict::Admit => {
                if let Some(noise) = weakened(&weighed, &self.config) {
                    estimate.correct(&weighed.with_noise(noise)?)?;
                    Outcome::Weakened
                } else {
                    estimate.correct(&weighed)?;
                    Outcome::Taken
                }
            }
            Verdict::Reject => Outcome::Rejected,
            Verdict::Recover => {
                estimate.correct_widened(&weighed, gate.gamma())?;
                Outcome::Recovered
            }
        };
        link.gate = gate;
        link.hear(sample.time_us, range);
        // A range that the estimate has to follow fits whatever it is worth.
        let redundant = self.heard as usize > D + usize::from(observes_bias);
        if redundant && let Some(learning) = &self.config.learning {
            link.variance = learnt(link.variance, learning, &weighed);
        }
        if verdict == Verdict::Reject {
            self.reject();
        } else {
            self.counters.take(seen.nis);
        }
        Ok(Report { outcome, innovation: Some(seen) })
    }

    /// Counts a range that was left out; when half of them are, the place is wrong, not they.
    fn reject(&mut self) {
        self.counters.reject();
        if self.counters.distrust > 2 * u16::from(self.heard.max(D as u8)) {
            self.estimate = None;
        }
    }

    /// Keeps a range for a first position, and makes one if it can.
    #[inline(never)] // Rare, and large.
    fn collect(&mut self, sample: &RangeSample<T>, range: T) -> Report<T> {
        let mut again = false;
        if let Some(link) = self.links.get_mut(sample.anchor) {
            again = link.fresh(self.time_us).is_some();
            link.hear(sample.time_us, range);
        }
        let started = self.begin(self.time_us, again);
        let outcome = if started { Outcome::Started } else { Outcome::Collected };
        Report { outcome, innovation: None }
    }

    /// Makes a position of the fresh ranges, if they are enough: when all anchors have been heard, or
    /// one of them `again`, before the others.
    fn begin(&mut self, now_us: u64, again: bool) -> bool {
        if !again && usize::from(self.count_heard(now_us)) < self.links.len() {
            return false;
        }
        self.estimate = start::<T, D, N, A>(&self.config, &self.links, now_us);
        if self.estimate.is_none() {
            return false;
        }
        for link in &mut self.links {
            *link = link.begun(&self.config);
        }
        self.heard = self.count_heard(now_us);
        self.counters.starts = self.counters.starts.saturating_add(1);
        self.counters.distrust = 0;
        self.counters.nis = T::ONE;
        true
    }

    #[inline]
    fn count_heard(&self, time_us: u64) -> u8 {
        self.links.iter().filter(|link| link.fresh(time_us).is_some()).count() as u8
    }

    #[inline]
    fn fresh_wheels(&self, time_us: u64) -> Option<&OdometrySample<T>> {
        let fresh =
            |wheels: &&OdometrySample<T>| time_us.saturating_sub(wheels.time_us) <= Self::WHEELS_US;
        self.wheels.as_ref().filter(fresh)
    }

    /// Whether IMU or wheels say that the tag stands, and may be believed.
    #[inline]
    fn is_still(&self, time_us: u64) -> bool {
        let wheels_stand =
            |wheels: &OdometrySample<T>| wheels.speed == T::ZERO && wheels.turn_rate == T::ZERO;
        time_us >= self.doubted_until_us
            && (self.stillness.is_still(time_us)
                || self.fresh_wheels(time_us).is_some_and(wheels_stand))
    }

    /// Ranges that fit so badly on average while the tag is said to stand have one that moves: a trolley on a
    /// smooth floor does not shake, and an IMU may have died.
    #[inline(never)] // Rare.
    fn doubt_standing(&mut self) {
        if !self.is_still(self.time_us) {
            return;
        }
        self.doubted_until_us = self.time_us.saturating_add(Self::DOUBT_US);
        if let Some(estimate) = &mut self.estimate {
            for index in D..2 * D {
                // Unless the variance is out of range already, in which case it is large enough.
                let _ = estimate.add_variance_at(index, T::from_f64(Self::DOUBTED_VARIANCE));
            }
        }
    }

    fn dilution(&self, time_us: u64) -> Option<T> {
        let position = self.position()?;
        let heard = self.links.iter().filter(|link| link.fresh(time_us).is_some());
        let directions = heard.map(|link| {
            expected_range(&position, self.config.height, &link.anchor.position).direction
        });
        dilution_of_precision(directions).ok()
    }
}

/// The row ∂h/∂x and the range that is expected.
#[inline]
fn predicted_range<T: Scalar, const D: usize, const N: usize>(
    estimate: &Gaussian<T, N>,
    config: &Config<T>,
    anchor: &Anchor<T>,
    observes_bias: bool,
) -> ([(usize, T); 4], T) {
    let mean = &estimate.mean.data.0[0];
    let position = SVector::<T, D>::from_fn(|axis, _| mean[axis]);
    let ExpectedRange { distance, direction } =
        expected_range(&position, config.height, &anchor.position);
    let mut row = [(0, T::ZERO); 4];
    for axis in 0..D {
        row[axis] = (axis, direction[axis]);
    }
    if N == 2 * D {
        return (row, distance);
    }
    row[D] = (2 * D, if observes_bias { T::ONE } else { T::ZERO });
    (row, if observes_bias { distance + mean[2 * D] } else { distance })
}

/// The noise that Huber gives a range beyond his threshold: S grows to S |ν|/(k √S).
#[inline(always)]
fn weakened<T: Scalar, const N: usize>(weighed: &Weighed<T, N>, config: &Config<T>) -> Option<T> {
    let huber = config.huber.as_ref()?;
    let threshold = huber.threshold(weighed.innovation());
    if !weighed.exceeds(threshold * threshold) {
        return None;
    }
    let variance = weighed.innovation().abs() * weighed.variance().sqrt() / threshold;
    Some((variance - weighed.spread()).max(weighed.noise()))
}
