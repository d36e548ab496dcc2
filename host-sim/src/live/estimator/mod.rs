//! The systems' estimators behind one face: a message at a time.

mod drone;
mod pedestrian;
mod robot;
mod uav;

use std::fmt::Debug;

use kestirim_telemetry::Message;

use super::options::{Live, SystemKind};
use crate::Error;
use crate::figure::Series;

/// An estimator that follows a stream.
pub(super) trait Estimator: Debug {
    /// Takes in a measurement.
    fn take(&mut self, message: &Message) -> Outcome;

    /// Nothing more is there for now: time for what takes long.
    fn settle(&mut self) {}

    /// The stream has ended.
    fn finish(&mut self) {}

    /// Where it is now, m, z up.
    fn position(&self) -> Option<[f64; 3]> {
        None
    }

    /// Deviations of angle of attack, pitch rate, airspeed and pitch.
    fn state(&self) -> Option<[f64; 4]> {
        None
    }

    /// Whether a foot stands.
    fn is_still(&self) -> bool {
        false
    }

    /// The horizontal length of the path of a walk, m.
    fn path_length_m(&self) -> Option<f64> {
        None
    }

    /// Numbers with their units, by name.
    fn facts(&self) -> Vec<(String, String)> {
        Vec::new()
    }

    /// What is suspicious about the stream.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }
}

/// What an estimator did with a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outcome {
    /// It is not for this estimator.
    NotMine,
    /// It made a difference.
    Taken,
    /// It cannot be true, or came too late.
    Refused,
}

impl Outcome {
    fn taken(taken: bool) -> Self {
        if taken { Self::Taken } else { Self::Refused }
    }
}

/// All that an estimator is built from, to build it again when the sender begins anew.
#[derive(Debug, Clone)]
pub(super) enum Plan {
    /// No estimator: what the sender estimates is shown.
    None,
    Pedestrian(pedestrian::Plan),
    Robot(robot::Plan),
    Drone(drone::Plan),
    Uav(Box<uav::Plan>),
}

impl Plan {
    /// Reads the files that the options name.
    ///
    /// # Errors
    /// Whatever is wrong with them, and options that are for another system.
    pub(super) fn read(options: &Live) -> Result<Self, Error> {
        refuse_strangers(options)?;
        Ok(match options.system {
            SystemKind::None => Self::None,
            SystemKind::Pedestrian => {
                Self::Pedestrian(pedestrian::Plan { sensor: options.sensor.unwrap_or_default() })
            }
            SystemKind::Robot => Self::Robot(robot::Plan::read(options)?),
            SystemKind::Drone => Self::Drone(drone::Plan::read(options)?),
            SystemKind::Uav => Self::Uav(Box::new(uav::Plan::read(options)?)),
        })
    }

    /// A fresh estimator.
    ///
    /// # Errors
    /// If the anchors will not do.
    pub(super) fn build(&self) -> Result<Option<Box<dyn Estimator>>, Error> {
        Ok(match self {
            Self::None => None,
            Self::Pedestrian(plan) => Some(Box::new(plan.build())),
            Self::Robot(plan) => Some(Box::new(plan.build()?)),
            Self::Drone(plan) => Some(Box::new(plan.build())),
            Self::Uav(plan) => Some(Box::new(plan.build())),
        })
    }

    /// What is drawn on the map before anything is known.
    pub(super) fn map(&self) -> Vec<Series> {
        match self {
            Self::Robot(plan) => vec![plan.anchors()],
            Self::Drone(plan) => plan.border().into_iter().collect(),
            Self::None | Self::Pedestrian(_) | Self::Uav(_) => Vec::new(),
        }
    }

    /// What was assumed because nobody said otherwise.
    pub(super) fn assumptions(&self) -> Vec<String> {
        match self {
            Self::Robot(plan) => plan.assumptions(),
            _ => Vec::new(),
        }
    }
}

/// Options that would change nothing.
fn refuse_strangers(options: &Live) -> Result<(), Error> {
    let given = [
        ("--sensor", options.sensor.is_some(), SystemKind::Pedestrian),
        ("--anchors", options.anchors.is_some(), SystemKind::Robot),
        ("--height", options.height.is_some(), SystemKind::Robot),
        ("--area", options.area.is_some(), SystemKind::Drone),
        ("--model", options.model.is_some(), SystemKind::Uav),
        ("--absolute", options.absolute, SystemKind::Uav),
    ];
    let stranger = given.iter().find(|(_, given, of)| *given && *of != options.system);
    match stranger {
        Some((option, _, of)) => {
            Err(Error::Usage(format!("{option} is for --system {}", of.name())))
        }
        None => Ok(()),
    }
}
