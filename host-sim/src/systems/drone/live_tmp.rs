//! A user on the ground, heard by a drone.

use kestirim_telemetry::{Message, PathLoss};
use kestirim_user_locator::Thinned;

use super::{Estimator, Outcome};
use crate::Error;
use crate::figure::{Colour, Mark, Series};
use crate::live::options::Live;
use crate::systems::drone::area::{self, Area};
use crate::systems::drone::flight::Stop;
use crate::systems::drone::online::{self, Found};

/// Where the user can be.
#[derive(Debug, Clone)]
pub(in crate::live) struct Plan {
    area: Option<Box<Area>>,
}

impl Plan {
    pub(super) fn read(options: &Live) -> Result<Self, Error> {
        let area = options.area.as_deref().map(area::read).transpose()?;
        Ok(Self { area })
    }

    pub(super) fn build(&self) -> Listener {
        Listener { stops: Box::default(), area: self.area.clone(), is_new: false, found: None }
    }

    pub(super) fn border(&self) -> Option<Series> {
        let corners = self.area.as_ref()?.corners();
        let closed = corners.iter().chain(corners.first()).copied();
        Some(Series::path("area", closed).marked(Mark::Dashes).coloured(Colour::Truth))
    }
}

/// Open ground and unknown antennas, as in a replay. The place is looked for from all that was heard, evenly
/// thinned where it is much.
#[derive(Debug)]
pub(super) struct Listener {
    stops: Box<Thinned<Stop, { online::MOST }>>,
    area: Option<Box<Area>>,
    /// Whether something was heard that is not yet in what was found.
    is_new: bool,
    found: Option<Found>,
}

impl Estimator for Listener {
    fn take(&mut self, message: &Message) -> Outcome {
        let Message::PathLoss(PathLoss { time_us, place, loss }) = *message else {
            return Outcome::NotMine;
        };
        let [x, y, height] = place.map(f64::from);
        let stop = Stop { t: time_us as f64 * 1e-6, place: [x, y], height, loss: f64::from(loss) };
        if !stop.is_somewhere() {
            return Outcome::Refused;
        }
        self.stops.push(stop);
        self.is_new = true;
        Outcome::Taken
    }

    fn settle(&mut self) {
        if std::mem::take(&mut self.is_new) {
            let stops = self.stops.as_slice().to_vec();
            self.found = online::locate(stops, self.area.as_deref()).or(self.found);
        }
    }

    fn finish(&mut self) {
        self.settle();
    }

    fn position(&self) -> Option<[f64; 3]> {
        self.found.map(|Found { place: [x, y], .. }| [x, y, 0.0])
    }

    fn facts(&self) -> Vec<(String, String)> {
        let Some(found) = self.found else { return Vec::new() };
        vec![("standard deviation".to_owned(), format!("{:.0} m", found.sd_m))]
    }
}
