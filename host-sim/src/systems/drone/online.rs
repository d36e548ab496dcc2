//! Locating a user on the ground from a live stream of a flying drone.

use kestirim_replay::drone::{Area, Estimate, MOST, Misfit, Quantity, Search, Stop};
use kestirim_telemetry::{Message, PathLoss};
use kestirim_user_locator::Thinned;

use super::account::next_in_words;
use super::recording::area;
use super::settings::{built, channel, wavelength_m};
use crate::Error;
use crate::figure::{Colour, Mark, Series};
use crate::system::{Files, Online, Outcome, Plan, Settings};
use crate::table::FARTHEST_POSITION;

/// The area of the user, and the settings including the environment.
#[derive(Debug, Clone)]
pub(super) struct Listening {
    area: Option<Box<Area>>,
    settings: Settings,
}

impl Listening {
    /// Reads the files.
    ///
    /// # Errors
    /// Errors in the file of the area.
    pub(super) fn read(settings: &Settings, files: &Files) -> Result<Self, Error> {
        let area = files.one("area").map(|path| area::read(path, None)).transpose()?;
        Ok(Self { area, settings: settings.clone() })
    }
}

impl Plan for Listening {
    fn build(&self) -> Result<Box<dyn Online>, Error> {
        let plan = self.clone();
        Ok(Box::new(Listener { stops: Box::default(), plan, is_new: false, found: None }))
    }

    fn map(&self) -> Vec<Series> {
        let border = self.area.iter().map(|area| {
            let corners = area.corners();
            let closed = corners.iter().chain(corners.first()).copied();
            Series::path("area", closed).marked(Mark::Dashes).coloured(Colour::Truth)
        });
        border.collect()
    }
}

/// Locates the user as a replay does, from all measurements so far, thinned out evenly if there are many.
#[derive(Debug)]
struct Listener {
    stops: Box<Thinned<Stop, MOST>>,
    plan: Listening,
    /// Whether a measurement has arrived that the estimate does not include yet.
    is_new: bool,
    found: Option<Estimate>,
}

impl Listener {
    /// Drops the measurements outside the time window at the time `now` (s).
    fn forget(&mut self, now: f64) {
        let Some(window_s) = self.plan.settings.number("window") else { return };
        let counts = |stop: &&Stop| stop.t >= now - window_s;
        if self.stops.as_slice().iter().all(|stop| counts(&stop)) {
            return;
        }
        let mut stops = Box::<Thinned<Stop, MOST>>::default();
        self.stops.as_slice().iter().filter(counts).for_each(|stop| stops.push(*stop));
        self.stops = stops;
    }

    /// The estimate of the user's position; `None` if no position explains the path losses, or from fewer than three.
    fn locate(&self) -> Option<Estimate> {
        let stops = self.stops.as_slice();
        if stops.len() < 3 {
            return None;
        }
        let Listening { area, settings } = &self.plan;
        let search = Search::new(stops, area.as_deref(), &[], 1, false).ok()?;
        search.at_wavelength(wavelength_m(settings)).find(built(settings), Quantity::PathLoss).pop()
    }
}

impl Online for Listener {
    fn take(&mut self, message: &Message) -> Outcome {
        let Message::PathLoss(PathLoss { time_us, place, loss }) = *message else {
            return Outcome::NotMine;
        };
        let [x, y, height] = place.map(f64::from);
        let (t, place, loss) = (time_us as f64 * 1e-6, [x, y], f64::from(loss));
        let stop = Stop { t, place, height, loss, heading: None };
        let is_on_earth = stop.place.iter().all(|axis| axis.abs() <= FARTHEST_POSITION);
        if !is_on_earth || !stop.is_usable() {
            return Outcome::Refused;
        }
        self.forget(t);
        self.stops.push(stop);
        self.is_new = true;
        Outcome::Taken
    }

    fn settle(&mut self) {
        if std::mem::take(&mut self.is_new) {
            self.found = self.locate().or(self.found.take());
        }
    }

    fn finish(&mut self) -> Result<(), Error> {
        self.settle();
        Ok(())
    }

    fn position(&self) -> Option<[f64; 3]> {
        self.found.as_ref().map(|Estimate { place: [x, y], .. }| [*x, *y, 0.0])
    }

    fn facts(&self) -> Vec<(String, String)> {
        let Some(found) = &self.found else { return Vec::new() };
        let mut facts = vec![("standard deviation".to_owned(), format!("{:.0} m", found.sd_m))];
        facts.extend(found.next.map(next_in_words));
        facts
    }

    fn warnings(&self) -> Vec<String> {
        let Listening { settings, .. } = &self.plan;
        let found = self.found.as_ref().zip(channel(settings));
        let misfit =
            found.and_then(|(it, channel)| Misfit::find(self.stops.as_slice(), it, &channel));
        let name = settings.choice("environment");
        misfit.iter().map(|misfit| misfit.sentence(&name, Quantity::PathLoss)).collect()
    }
}
