//! A user on the ground, heard by a drone.

use kestirim_telemetry::{Message, PathLoss};

use super::{Estimator, Outcome};
use crate::Error;
use crate::figure::{Colour, Mark, Series};
use crate::commands::live::options::Live;
use crate::commands::live::thinned::Thinned;
use crate::systems::drone::area::Area;
use crate::systems::drone::flight::Stop;
use crate::systems::drone::online::{self, Found};

/// Where the user can be.
#[derive(Debug, Clone)]
pub(in crate::live) struct Plan {
    area: Option<Area>,
}

impl Plan {
    pub(super) fn read(options: &Live) -> Result<Self, Error> {
        let area = options.area.as_deref().map(Area::read).transpose()?;
        Ok(Self { area })
    }

    pub(super) fn build(&self) -> Listener {
        Listener {
            // One more is the last.
            stops: Thinned::new(online::MOST - 1),
            area: self.area.clone(),
            is_new: false,
            found: None,
        }
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
    stops: Thinned<Stop>,
    area: Option<Area>,
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
            let stops = self.stops.iter().collect();
            self.found = online::locate(stops, self.area.as_ref()).or(self.found);
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
