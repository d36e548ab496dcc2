//! A tag among anchors.

use std::fmt;

use kestirim_telemetry::{Imu, Message, Range};

use super::{Estimator, Outcome};
use crate::Error;
use crate::system::ScalarKind;
use crate::figure::{Colour, Series};
use crate::commands::live::options::Live;
use crate::systems::robot::anchors::{self, Anchors};
use crate::systems::robot::follow::{self, Follow};
use crate::systems::robot::motion::Inertial;
use crate::systems::robot::options::{Dimensions, Setup, TrackerKind};
use crate::systems::robot::scenario;

/// Where the anchors are.
#[derive(Debug, Clone)]
pub(in crate::live) struct Plan {
    anchors: Anchors,
    setup: Setup,
    assumptions: Vec<String>,
}

impl Plan {
    pub(super) fn read(options: &Live) -> Result<Self, Error> {
        let mut assumptions = Vec::new();
        let anchors = if let Some(path) = &options.anchors {
            anchors::read(path)?
        } else {
            let office = "the anchors are taken to be those of the paper's office (--anchors)";
            assumptions.push(office.to_owned());
            office_anchors()
        };
        let height_m = options.height.unwrap_or_else(|| anchors.mean_height());
        if options.height.is_none() {
            assumptions.push(format!(
                "the tag's height is taken to be that of the anchors, {height_m:.2} m (--height)"
            ));
        }
        let setup = Setup {
            tracker: TrackerKind::Default,
            dimensions: Dimensions::Two,
            scalar: ScalarKind::F32,
            room: None,
            height_m,
            anchors: anchors.positions.clone(),
            biases: None,
        };
        Ok(Self { anchors, setup, assumptions })
    }

    pub(super) fn build(&self) -> Result<Tag, Error> {
        let tracker = follow::build(&self.setup)?;
        Ok(Tag { tracker, begun_us: None })
    }

    pub(super) fn anchors(&self) -> Series {
        let places = self.anchors.positions.iter().map(|[x, y, _]| [*x, *y]);
        Series::points("anchors", places)
            .labelled(self.anchors.names.clone())
            .coloured(Colour::Truth)
    }

    pub(super) fn assumptions(&self) -> Vec<String> {
        self.assumptions.clone()
    }
}

fn office_anchors() -> Anchors {
    let positions = scenario::ANCHORS.to_vec();
    let names = (1..=positions.len()).map(|number| format!("A{number}")).collect();
    Anchors { names, positions }
}

/// The default tracker, in the plane and in single precision. Anchors are numbered from 0, in the order of
/// their file.
pub(super) struct Tag {
    tracker: Box<dyn Follow>,
    begun_us: Option<u64>,
}

impl fmt::Debug for Tag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tag").field("begun_us", &self.begun_us).finish_non_exhaustive()
    }
}

impl Tag {
    /// Since the first measurement; none of what is older.
    fn since(&mut self, time_us: u64) -> Option<u64> {
        time_us.checked_sub(*self.begun_us.get_or_insert(time_us))
    }
}

impl Estimator for Tag {
    fn take(&mut self, message: &Message) -> Outcome {
        let (time_us, acceleration) = match *message {
            Message::Range(Range { time_us, .. }) => (time_us, None),
            Message::Imu(Imu { time_us, specific_force, .. }) => (time_us, Some(specific_force)),
            _ => return Outcome::NotMine,
        };
        let Some(since_us) = self.since(time_us) else { return Outcome::Refused };
        if let Message::Range(Range { anchor, range, .. }) = *message {
            let taken = self.tracker.range(since_us, anchor.into(), range.into());
            self.tracker.end_epoch(since_us);
            return Outcome::taken(taken.taken);
        }
        if let Some(acceleration) = acceleration {
            let acceleration = acceleration.map(f64::from);
            let sample = Inertial { time_us: since_us as i64, acceleration, push: None };
            self.tracker.inertial(since_us, &sample);
        }
        Outcome::Taken
    }

    fn position(&self) -> Option<[f64; 3]> {
        self.tracker.position()
    }
}
