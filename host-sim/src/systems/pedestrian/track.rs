//! Tracking of a recording.

use kestirim_pedestrian::SensorClass;
use kestirim_replay::pedestrian::{self, Trace, Walk, sensor_class, trace, walk};

use super::recording::Recording;
use super::settings::{LOOKING_BACK, is_at_right_angles, is_closed, options, turns_back};
use crate::Error;
use crate::system::{Detail, Settings};

/// The tracker's results for a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// The recording at another rate, if one was selected.
    averaged: Option<Recording>,
    /// The trace, without moments if only the result was wanted.
    pub trace: Trace,
}

impl Track {
    /// Tracks a recording according to the settings.
    ///
    /// # Errors
    /// [`Error::File`] if the tracker refuses the log, [`Error::Usage`] for a rate that the log does not support.
    pub fn of(recording: &Recording, settings: &Settings, detail: Detail) -> Result<Self, Error> {
        let rate_hz = settings.number("rate");
        let averaged = rate_hz.map(|rate_hz| recording.at_rate(rate_hz)).transpose()?;
        let tracked = averaged.as_ref().unwrap_or(recording);
        let mut trace = foot(tracked, settings, detail)?;
        if let Some(other) = &tracked.other_foot {
            join(&mut trace.walk, other, settings)?;
        }
        if is_at_right_angles(settings)
            && let Err(refused) = trace.walk.align_to_right_angles()
        {
            trace.walk.warnings.push(refused);
        }
        if is_closed(settings)
            && let Err(refused) = trace.walk.close()
        {
            trace.walk.warnings.push(refused);
        }
        trace.turn_moments();
        Ok(Self { averaged, trace })
    }

    /// The recording that was tracked: at another rate, if one was selected.
    pub fn tracked<'a>(&'a self, recording: &'a Recording) -> &'a Recording {
        self.averaged.as_ref().unwrap_or(recording)
    }
}

/// Tracks one foot, and corrects its heading by the magnetometer.
fn foot(recording: &Recording, settings: &Settings, detail: Detail) -> Result<Trace, Error> {
    let samples = &recording.log.samples;
    let options = options(settings).with_sensor(|| class_of(recording));
    let field = recording.log.field.as_ref().filter(|_| options.magnetometer);
    let tracked = match detail {
        Detail::Result => walk(samples, &options).map(|walk| Trace { walk, ..Trace::default() }),
        Detail::Every => trace(samples, &options),
    };
    let mut trace = tracked.map_err(|error| refused(recording, &error))?;
    if let Some(field) = field {
        trace.walk.correct_heading(samples, field, &options);
    }
    Ok(trace)
}

/// Corrects a foot by the other one, or warns why it cannot; warnings about the other's log are added as well.
fn join(walk: &mut Walk, other: &Recording, settings: &Settings) -> Result<(), Error> {
    if !turns_back(settings) {
        walk.warnings.push(format!("the other foot is not used: it {LOOKING_BACK}"));
        return Ok(());
    }
    let other_walk = foot(other, settings, Detail::Result)?.walk;
    match walk.join_other_foot(&other_walk) {
        Ok(_) => walk.doubts = walk.doubts.and(other_walk.doubts),
        Err(refused) => walk.warnings.push(refused),
    }
    let warnings = other.log.warnings.iter().chain(&other_walk.warnings);
    walk.warnings.extend(warnings.map(|warning| format!("the other foot: {warning}")));
    Ok(())
}

/// The error that the tracker refuses a recording.
pub(super) fn refused(recording: &Recording, error: &pedestrian::Error) -> Error {
    Error::File { path: recording.path.clone(), problem: error.to_string() }
}

/// The class of a recording's sensor, determined once; that of bare chips if the sensor was never stationary. The truth
/// is not used.
pub(super) fn class_of(recording: &Recording) -> SensorClass {
    let found = || sensor_class(&recording.log.samples, recording.measured());
    *recording.class.get_or_init(found)
}
