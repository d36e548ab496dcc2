//! Follows a live tag in the same way as firmware does.

use kestirim_replay::robot::{
    self, Anchors, Dimensions, Event, Follow, HeightSearch, Inertial, Setup, build,
};
use kestirim_telemetry::{Imu, Message, Range};

use super::recording::anchors;
use super::recording::calibration;
use super::settings;
use super::simulate::scenario::office_anchors;
use super::track::refused;
use crate::Error;
use crate::figure::{Colour, Series};
use crate::system::{Files, Health, Online, Outcome, Plan, Settings};

/// The anchors and settings of a live tag.
#[derive(Debug)]
pub(super) struct Tag {
    anchors: Anchors,
    setup: Setup,
    /// Whether the height of the tag is not given.
    is_height_missing: bool,
    assumptions: Vec<String>,
}

impl Tag {
    /// Reads the files.
    ///
    /// # Errors
    /// Errors in the files.
    pub(super) fn read(settings: &Settings, files: &Files) -> Result<Self, Error> {
        let mut assumptions = Vec::new();
        let anchors = if let Some(path) = files.one("anchors") {
            anchors::read(path)?
        } else {
            let office = "the anchors are taken to be those of the paper's office (--anchors)";
            assumptions.push(office.to_owned());
            office_anchors()
        };
        let calibration = files.one("calibration").map(|path| calibration::of(path, &anchors));
        let (biases, warnings) = calibration.transpose()?.unzip();
        let setup = settings::of(settings, &anchors, biases.as_deref());
        let is_height_missing = setup.dimensions == Dimensions::Two && !settings.is_given("height");
        if is_height_missing {
            assumptions.push(format!(
                "until the ranges tell the tag's height it is taken to be that of the anchors, {:.2} m (--height)",
                setup.height_m
            ));
        }
        assumptions.extend(warnings.unwrap_or_default());
        Ok(Self { anchors, setup, is_height_missing, assumptions })
    }
}

impl Plan for Tag {
    fn build(&self) -> Result<Box<dyn Online>, Error> {
        let finder = self.is_height_missing.then(|| HeightSearch::new(&self.setup));
        let finder = finder.transpose().map_err(refused)?;
        Ok(Box::new(Followed {
            tracker: build(&self.setup).map_err(refused)?,
            setup: self.setup.clone(),
            finder: finder.map(Box::new),
            begun_us: None,
        }))
    }

    fn map(&self) -> Vec<Series> {
        let places = self.anchors.positions.iter().map(|[x, y, _]| [*x, *y]);
        let anchors = Series::points("anchors", places);
        vec![anchors.labelled(self.anchors.names.clone()).coloured(Colour::Truth)]
    }

    fn assumptions(&self) -> Vec<String> {
        self.assumptions.clone()
    }
}

/// A time that no clock shows (µs): in snapshots, it marks an estimator that has not started.
const NOT_BEGUN: u64 = u64::MAX;

/// A live tracker. Anchors are numbered from 0, in the order of their file.
#[derive(Debug)]
struct Followed {
    tracker: Box<dyn Follow>,
    setup: Setup,
    /// The search for the height, until it is found.
    finder: Option<Box<HeightSearch>>,
    begun_us: Option<u64>,
}

impl Followed {
    /// Continues the search for the height. Once the ranges determine it, tracking restarts at that height.
    fn look_for_height(&mut self, time_us: u64, range: &robot::Range) {
        let Some(finder) = &mut self.finder else { return };
        if !finder.take(time_us, range) {
            return;
        }
        let Ok(found) = finder.found() else { return };
        let setup = self.setup.clone().at(found);
        if let Ok(tracker) = build(&setup) {
            (self.tracker, self.setup, self.finder) = (tracker, setup, None);
        }
    }
}

impl Online for Followed {
    fn take(&mut self, message: &Message) -> Outcome {
        let (time_us, event) = match *message {
            Message::Range(Range { time_us, anchor, range }) => {
                let (anchor, metres) = (anchor.into(), range.into());
                (time_us, Event::Range(robot::Range { time_us: time_us as i64, anchor, metres }))
            }
            Message::Imu(Imu { time_us, specific_force, .. }) => {
                let acceleration = specific_force.map(f64::from);
                let time = time_us as i64;
                (time_us, Event::Inertial(Inertial { time_us: time, acceleration, push: None }))
            }
            _ => return Outcome::NotMine,
        };
        let begun_us = *self.begun_us.get_or_insert(time_us);
        let Some(since_us) = time_us.checked_sub(begun_us) else { return Outcome::Refused };
        if let Event::Range(range) = &event {
            self.look_for_height(since_us, range);
        }
        let reception = self.tracker.take(since_us, &event);
        if let Event::Range(robot::Range { time_us, .. }) = event {
            self.tracker.take(since_us, &Event::EpochEnd { time_us });
            return Outcome::taken(reception.taken);
        }
        Outcome::Taken
    }

    fn position(&self) -> Option<[f64; 3]> {
        self.tracker.position()
    }

    fn sigma_m(&self) -> Option<f64> {
        self.tracker.spread().map(|[xx, _, yy]| (0.5 * (xx + yy)).sqrt())
    }

    fn health(&self) -> Option<Health> {
        self.position().map(|_| self.tracker.health())
    }

    fn snapshot(&self) -> Result<Vec<u8>, String> {
        if self.finder.is_some() {
            return Err("the tag's height is not known: expected --height".to_owned());
        }
        let tracker = self.tracker.snapshot().ok_or("this tracker cannot be stored (--tracker)")?;
        let begun_us = self.begun_us.unwrap_or(NOT_BEGUN).to_le_bytes();
        Ok([&begun_us[..], &tracker].concat())
    }

    fn restore(&mut self, snapshot: &[u8]) -> Option<()> {
        let (begun_us, tracker) = snapshot.split_first_chunk()?;
        self.tracker.restore(tracker)?;
        self.begun_us = Some(u64::from_le_bytes(*begun_us)).filter(|&time| time != NOT_BEGUN);
        Some(())
    }
}
