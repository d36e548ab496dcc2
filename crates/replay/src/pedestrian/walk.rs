//! Feeds a walk to a tracker with the chosen number type, mode and shape.

use std::marker::PhantomData;

use kestirim_health::{Health, Reason, State};
use kestirim_pedestrian::detector::StanceDetector;
use kestirim_pedestrian::{
    Config, Ekf, Estimate, ImuSample, Lite, Navigator, OfflineTracker, PathUncertainty, Tracker,
    Warnings,
};
use kestirim_scalar::{Components, Q12_20, Scalar};
use nalgebra::SVector;

use super::carried::carried;
use super::choices::{WithDetector, with_detector};
use super::smoothed::smooth;
use super::trace::{Moment, OnlyAtStart, See, Updates};
use super::{
    BothFeet, DetectorKind, Error, Options, RightAngles, Sample, SensorClass, TrackPoint,
    TrackerKind, sentences,
};
use crate::{Number, ScalarKind};

const NO_STRIDE: &str = "no stride was found: the sensor is not on a foot, or nobody walked";

/// A tracked walk, in the room frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Walk {
    /// The positions, one for every sample.
    pub track: Vec<TrackPoint>,
    /// The strides, in order.
    pub strides: Vec<Stride>,
    /// The horizontal length of the path, from stance to stance, m.
    pub path_length_m: f64,
    /// Horizontal distance from start to end, m.
    pub closure_m: f64,
    /// The drift rate of the heading that was corrected, rad/s: the sum of what a magnetometer, the other foot, right
    /// angles and a closed path showed.
    pub heading_rate: Option<f64>,
    /// How well the walk follows walls at right angles, if it was [corrected by them](Self::align_to_right_angles).
    pub right_angles: Option<RightAngles>,
    /// How well the other sensor fitted, if there was one and the walk was [corrected by it](Self::join_other_foot).
    pub both_feet: Option<BothFeet>,
    /// The distance of the end from the start, m, before the walk was [closed](Self::close).
    pub gap_m: Option<f64>,
    /// The warnings about the sensor or the walk.
    pub warnings: Vec<String>,
    /// The class of sensor for which it was tracked.
    pub sensor: SensorClass,
    /// The doubts about the walk.
    pub doubts: Health,
    /// How far the walk can be relied upon: each change, with the index of the track from which on it holds.
    pub health: Vec<(usize, State)>,
}

/// One stride of the foot, from stance to stance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stride {
    /// The end of the stance that follows the stride, µs.
    pub time_us: u64,
    /// The position of the foot at that time, m.
    pub position: [f64; 3],
    /// The horizontal distance from the previous stance, m.
    pub length_m: f64,
    /// The time since the previous stance, s.
    pub duration_s: f64,
    /// The turn with respect to the previous stride, rad, anticlockwise.
    pub heading_change_rad: f64,
    /// The time during the stride for which the motion of the foot is unknown, s.
    pub unseen_s: f64,
    /// The angle turned during the stride beyond the end of the gyroscope's range, rad.
    pub bridged_rad: f64,
    /// Relative error of gravity at rest so far, with its standard deviation.
    pub gravity_off: f64,
    /// Standard deviations of the position, m.
    pub sigma_m: [f64; 3],
}

/// Tracks a walk.
///
/// # Errors
/// An error if the log is too short or holds a sample that the tracker rejects.
pub fn walk(samples: &[Sample], options: &Options) -> Result<Walk, Error> {
    watched(samples, options, Updates::InStance, &mut |_| ())
}

/// Tracks a walk and passes each moment of it to `see`.
pub(super) fn watched(
    samples: &[Sample],
    options: &Options,
    updates: Updates,
    see: &mut See<'_>,
) -> Result<Walk, Error> {
    if samples.len() < 2 {
        return Err(Error::TooShort { found: samples.len(), needed: 2 });
    }
    if !options.smooth || updates == Updates::OnlyAtStart {
        return tracked(samples, options, updates, see);
    }
    let mut moments = Vec::with_capacity(samples.len());
    let mut walk = tracked(samples, options, updates, &mut |moment| moments.push(moment))?;
    smooth(&mut walk, &mut moments);
    moments.into_iter().for_each(see);
    Ok(walk)
}

fn tracked(
    samples: &[Sample],
    options: &Options,
    updates: Updates,
    see: &mut See<'_>,
) -> Result<Walk, Error> {
    let mut walk = match options.scalar {
        ScalarKind::F32 => with_scalar::<f32>(samples, options, updates, see),
        ScalarKind::F64 => with_scalar::<f64>(samples, options, updates, see),
        ScalarKind::Fixed => with_scalar::<Q12_20>(samples, options, updates, see),
    }?;
    if let Some(from) = carried(samples) {
        walk.doubt_from(from, Reason::Innovations);
        let seconds = (samples[from].time_us - samples[0].time_us) as f64 * 1e-6;
        // This warning comes first: implausible gravity may be due to it.
        walk.warnings.insert(0, format!(
            "{seconds:.0} s after the start the foot is carried while it stands (by a lift, an escalator, a vehicle): how far \
             no sensor on the foot tells, and places from there on are wrong"
        ));
    }
    Ok(walk)
}

fn with_scalar<T: Number>(
    samples: &[Sample],
    options: &Options,
    updates: Updates,
    see: &mut See<'_>,
) -> Result<Walk, Error> {
    match options.tracker {
        TrackerKind::Lite => with_navigator::<T, Lite<T>>(samples, options, updates, see),
        TrackerKind::Ekf => with_navigator::<T, Ekf<T>>(samples, options, updates, see),
    }
}

fn with_navigator<T: Number, N: Navigator<T>>(
    samples: &[Sample],
    options: &Options,
    updates: Updates,
    see: &mut See<'_>,
) -> Result<Walk, Error> {
    let samples: Vec<_> = samples.iter().map(imu_sample).collect();
    let config = options.config();
    if updates == Updates::OnlyAtStart {
        return causal::<T, N, _>(&samples, config, OnlyAtStart::default(), see);
    }
    if options.detector == DetectorKind::Adaptive && !options.causal {
        return offline::<T, N>(&samples, config, see);
    }
    with_detector(
        options,
        Causally::<T, N> { samples: &samples, config, see, navigator: PhantomData },
    )
}

/// A log, tracked sample by sample.
struct Causally<'a, 'b, T: Scalar, N> {
    samples: &'a [ImuSample<T>],
    config: Config<T>,
    see: &'a mut See<'b>,
    navigator: PhantomData<N>,
}

impl<T: Scalar, N: Navigator<T>> WithDetector<T> for Causally<'_, '_, T, N> {
    type Output = Result<Walk, Error>;

    fn with<D: StanceDetector<T> + std::fmt::Debug + 'static>(self, detector: D) -> Self::Output {
        causal::<T, N, D>(self.samples, self.config, detector, self.see)
    }
}

fn causal<T: Scalar, N: Navigator<T>, D: StanceDetector<T>>(
    samples: &[ImuSample<T>],
    config: Config<T>,
    detector: D,
    see: &mut See<'_>,
) -> Result<Walk, Error> {
    let mut tracker = Tracker::<T, N, D>::with_detector(config, detector);
    let mut walk = Walk::default();
    for (index, sample) in samples.iter().enumerate() {
        let estimate =
            tracker.update(sample).map_err(|source| Error::Sample { index: index + 1, source })?;
        walk.push(&estimate, see);
        walk.doubt(tracker.warnings());
    }
    walk.finish(tracker.finish(), tracker.path_length(), tracker.warnings(), config.sensor);
    Ok(walk)
}

fn offline<T: Scalar, N: Navigator<T>>(
    samples: &[ImuSample<T>],
    config: Config<T>,
    see: &mut See<'_>,
) -> Result<Walk, Error> {
    let mut energy = vec![T::ZERO; samples.len()];
    let mut tracker = OfflineTracker::<T, N>::new(config, samples, &mut energy)
        .map_err(|(index, source)| Error::Sample { index: index + 1, source })?;
    let mut walk = Walk::default();
    while let Some(estimate) = tracker.next() {
        walk.push(&estimate, see);
        walk.doubt(tracker.warnings());
    }
    walk.finish(tracker.finish(), tracker.path_length(), tracker.warnings(), config.sensor);
    Ok(walk)
}

impl Walk {
    fn push<T: Scalar>(&mut self, estimate: &Estimate<T>, see: &mut See<'_>) {
        see(Moment {
            velocity: double(&estimate.velocity),
            orientation: estimate.orientation.quaternion().map(T::to_f64),
            stance: estimate.stance,
        });
        let position = double(&estimate.position);
        self.track.push(TrackPoint { time_us: estimate.time_us, position });
        self.strides.extend(estimate.stride.as_ref().map(Stride::from_estimate));
    }

    /// Marks the walk as affected by a reason from this entry of the track on.
    fn doubt_from(&mut self, from: usize, reason: Reason) {
        self.doubts.add(reason);
        let place = self.health.partition_point(|(before, _)| *before <= from);
        self.health.insert(place, (from, reason.state()));
    }

    /// Marks the walk as no better than its warnings from here on. That it began without a standstill is reported at
    /// the end, if none came.
    fn doubt(&mut self, warnings: Warnings) {
        let state = Warnings { never_still: false, ..warnings }.health().state();
        let before = self.health.last().map_or(State::Good, |(_, before)| *before);
        if before < state {
            self.health.push((self.track.len().saturating_sub(1), state));
        }
    }

    /// How far each entry of the track can be relied upon.
    pub fn healths(&self) -> impl Iterator<Item = State> {
        let never_still = self.doubts.has(Reason::NotObservable);
        let from_the_start = Health::GOOD.with(Reason::NotObservable, never_still).state();
        let (mut changes, mut now) = (self.health.iter().peekable(), from_the_start);
        (0..self.track.len()).map(move |index| {
            while let Some((_, state)) = changes.next_if(|(from, _)| *from <= index) {
                now = now.max(*state);
            }
            now
        })
    }

    /// Standard deviations of the position at ascending times, µs: those of the previous stride, or, if the motion was
    /// not completely observed, those of the current one, m.
    pub fn sigmas_m(&self, times_us: impl Iterator<Item = u64>) -> impl Iterator<Item = [f64; 3]> {
        let before_the_first = PathUncertainty::<f64>::new(self.sensor.into());
        let mut now = before_the_first.standard_deviation().into();
        let mut strides = self.strides.iter().peekable();
        times_us.map(move |time_us| {
            while let Some(stride) = strides.next_if(|stride| stride.time_us <= time_us) {
                now = stride.sigma_m;
            }
            strides.peek().filter(|it| it.is_unseen()).map_or(now, |stride| stride.sigma_m)
        })
    }

    fn finish<T: Scalar>(
        &mut self,
        last: Option<kestirim_pedestrian::Stride<T>>,
        path_length: T,
        warnings: Warnings,
        sensor: kestirim_pedestrian::SensorClass,
    ) {
        self.sensor = sensor.into();
        self.strides.extend(last.as_ref().map(Stride::from_estimate));
        let mut uncertainty = PathUncertainty::new(sensor);
        for stride in &mut self.strides {
            uncertainty.add(&stride.of_the_crate());
            stride.sigma_m = uncertainty.standard_deviation().into();
        }
        self.path_length_m = path_length.to_f64();
        if let Some(TrackPoint { position: [x, y, _], .. }) = self.track.last() {
            self.closure_m = x.hypot(*y);
        }
        (self.warnings, self.doubts) = (sentences(warnings), warnings.health());
        self.warnings.extend(self.unseen());
        if self.strides.is_empty() {
            self.warnings.push(NO_STRIDE.to_owned());
        }
    }

    /// A sentence about the strides that were not completely observed, if any.
    fn unseen(&self) -> Option<String> {
        let mut strides = self.strides.iter().filter(|stride| stride.is_unseen());
        let first = strides.next()?;
        let start_us = self.track.first().map_or(0, |point| point.time_us);
        let (count, seconds) = strides.fold((1, first.unseen_s), |(count, seconds), stride| {
            (count + 1, seconds + stride.unseen_s)
        });
        Some(format!(
            "strides that were not seen as a whole: {count}, for {seconds:.1} s, the first until {:.1} s after the start; from there on the \
             standard deviation has what the heading may have lost",
            first.time_us.saturating_sub(start_us) as f64 * 1e-6
        ))
    }
}

impl Stride {
    fn from_estimate<T: Scalar>(stride: &kestirim_pedestrian::Stride<T>) -> Self {
        Self {
            time_us: stride.time_us,
            position: double(&stride.position),
            length_m: stride.length.to_f64(),
            duration_s: stride.duration.to_f64(),
            heading_change_rad: stride.heading_change.to_f64(),
            unseen_s: stride.unseen.to_f64(),
            bridged_rad: stride.bridged.to_f64(),
            gravity_off: stride.gravity_off.to_f64(),
            sigma_m: [0.0; 3],
        }
    }

    fn of_the_crate(&self) -> kestirim_pedestrian::Stride<f64> {
        kestirim_pedestrian::Stride {
            time_us: self.time_us,
            position: self.position.into(),
            length: self.length_m,
            duration: self.duration_s,
            heading_change: self.heading_change_rad,
            unseen: self.unseen_s,
            bridged: self.bridged_rad,
            gravity_off: self.gravity_off,
        }
    }

    /// Whether a part of the stride was not observed.
    pub(super) fn is_unseen(&self) -> bool {
        self.unseen_s > 0.0
    }
}

/// Converts a sample to the tracker's type.
pub(super) fn imu_sample<T: Scalar>(sample: &Sample) -> ImuSample<T> {
    ImuSample {
        time_us: sample.time_us,
        specific_force: SVector::from(sample.specific_force.map(T::from_f64)),
        angular_rate: SVector::from(sample.angular_rate.map(T::from_f64)),
    }
}

pub(super) fn double<T: Scalar>(vector: &SVector<T, 3>) -> [f64; 3] {
    vector.as_array().map(T::to_f64)
}
