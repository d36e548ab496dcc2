//! Logs of flights.

use std::path::Path;

use kestirim_import::{Options, levels};
use kestirim_replay::drone::{Quantity, Stop};

use super::plane::{Origin, Places};
use super::users::Users;
use crate::Error;
use crate::table::{self, Column, Found, Header, Log};
use crate::text;

/// The contents of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct Flight {
    /// The measured quantity.
    pub quantity: Quantity,
    /// The measurements of the user looked for, in chronological order.
    pub stops: Vec<Stop>,
    /// The name of the transmitter looked for, if the log states it.
    pub transmitter: Option<String>,
    /// The measurements of other transmitters, unless they were excluded.
    pub others: Vec<Heard>,
    /// The number of rows that no channel model can use: without a height, or with a loss that no radio measures.
    pub unusable: usize,
    /// The point where the plane touches the Earth, if positions were given by latitude and longitude.
    pub origin: Option<Origin>,
}

/// The measurements of a transmitter.
#[derive(Debug, Clone, PartialEq)]
pub struct Heard {
    /// The name of the transmitter in the log.
    pub name: String,
    /// The measurements in chronological order.
    pub stops: Vec<Stop>,
}

/// The usual range of the time from stop to stop (s).
const USUAL_STEP_S: [f64; 2] = [2e-3, 60.0];
/// Reads columns t,x,y,h, or t,lat,lon,h, and `path_loss_db` or `rssi_db`; or levels with positions in a ROS 1 bag or
/// MCAP. If a column user names several transmitters, `--topic` selects one; otherwise all are read. The drone's
/// heading (degrees clockwise from y, north) is read if there is a column for it.
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read(path: &Path, options: &Options) -> Result<(Flight, Found), Error> {
    let bytes = text::unpacked(path)?;
    let levels = levels::read(&bytes, options).map_err(|error| table::refused(path, &error))?;
    if let Some(levels) = levels {
        return Ok(of_levels(levels));
    }
    let mut flight = Flight::new(Quantity::PathLoss);
    let mut users = Users::new(options.topic.as_deref());
    let mut found = table::parse(
        path,
        &bytes,
        &Log { what: "a recorded flight", usual_step_s: Some(USUAL_STEP_S), options },
        columns,
        |&Columns { places, measured: [t, h, value], quantity, user, heading }, row| {
            flight.quantity = quantity;
            let t = row.time_us(t)? as f64 * 1e-6;
            let place = places.read(row, &mut flight.origin)?;
            let height = row.number("h", h)?;
            // An empty field means that no measurement was received.
            if row.is_empty(value) {
                flight.unusable += 1;
                return Ok(());
            }
            let loss = match quantity {
                Quantity::PathLoss => row.number("path_loss_db", value)?,
                Quantity::Level => -row.number("rssi_db", value)?,
            };
            let heading = match heading {
                Some(column) if !row.is_empty(column) => {
                    Some(row.number("heading", column)?.to_radians())
                }
                _ => None,
            };
            let stop = Stop { t, place, height, loss, heading };
            let is_usable = stop.is_usable();
            let name = user.map(|user| row.text(user)).unwrap_or_default();
            let is_meant = users.hear(&name, stop, is_usable);
            flight.unusable += usize::from(is_meant && !is_usable);
            Ok(())
        },
    )?;
    found.import.extend(users.decide(path, &mut flight)?);
    found.warnings.extend(flight.put_in_order());
    let is_positive = |stop: &Stop| stop.loss < 0.0;
    if flight.quantity == Quantity::Level
        && !flight.stops.is_empty()
        && flight.stops.iter().all(is_positive)
    {
        let warning = "all levels are above 0 dB: if the column has them without their minus sign, --columns rssi_db=-NAME";
        found.warnings.push(warning.to_owned());
    }
    Ok((flight, found))
}

impl Flight {
    /// A flight without measurements.
    pub fn new(quantity: Quantity) -> Self {
        let (stops, others) = (Vec::new(), Vec::new());
        Self { quantity, stops, transmitter: None, others, unusable: 0, origin: None }
    }

    /// Sorts the measurements by time; returns a warning if those of the user looked for were not.
    fn put_in_order(&mut self) -> Option<String> {
        let falls = |pair: &&[Stop]| pair[1].t < pair[0].t;
        let before = self.stops.windows(2).find(falls).map(|pair| pair[0].t);
        let in_order = |stops: &mut Vec<Stop>| stops.sort_by(|a, b| a.t.total_cmp(&b.t));
        in_order(&mut self.stops);
        self.others.iter_mut().for_each(|other| in_order(&mut other.stops));
        before.map(|before| {
            format!(
                "times fall back after {before:.1} s: measurements are taken in the order of time; if the clock began anew there, split the log"
            )
        })
    }
}

fn of_levels(levels: levels::Levels) -> (Flight, Found) {
    let quantity = if levels.are_losses { Quantity::PathLoss } else { Quantity::Level };
    let mut flight = Flight::new(quantity);
    for heard in levels.heard {
        let loss = if levels.are_losses { heard.level } else { -heard.level };
        let place = Origin::place(&mut flight.origin, heard.latitude, heard.longitude);
        let t = heard.time_us as f64 * 1e-6;
        let stop = place.map(|place| Stop { t, place, height: heard.height, loss, heading: None });
        match stop.filter(Stop::is_usable) {
            Some(stop) => flight.stops.push(stop),
            None => flight.unusable += 1,
        }
    }
    (flight, Found { import: levels.conclusions, warnings: levels.damage.sentences() })
}

/// The columns of a log.
#[derive(Debug, Clone, Copy)]
struct Columns {
    places: Places,
    /// The columns of the time, the height and the measured quantity.
    measured: [Column; 3],
    quantity: Quantity,
    user: Option<Column>,
    heading: Option<Column>,
}

fn columns(header: &Header<'_>) -> Result<Columns, Error> {
    let (places, user, heading) =
        (Places::find(header)?, header.find("user")?, header.find("heading")?);
    let (name, quantity) = if header.find("path_loss_db")?.is_some() {
        ("path_loss_db", Quantity::PathLoss)
    } else {
        ("rssi_db", Quantity::Level)
    };
    Ok(Columns { places, measured: header.require(["t", "h", name])?, quantity, user, heading })
}
