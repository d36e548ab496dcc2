//! Recorded flights.

use std::path::Path;

use kestirim_import::{Options, levels};
use kestirim_replay::drone::{Quantity, Stop};

use super::plane::{Origin, Places};
use super::users::Users;
use crate::Error;
use crate::table::{self, Column, Found, Header, Log};
use crate::text;

/// A log.
#[derive(Debug, Clone, PartialEq)]
pub struct Flight {
    /// What was measured.
    pub quantity: Quantity,
    /// In the order of their times.
    pub stops: Vec<Stop>,
    /// Of whom, if the log says it.
    pub transmitter: Option<String>,
    /// Of other transmitters, of which nobody said that they are not looked for.
    pub others: Vec<Heard>,
    /// Rows that no channel can use: without height, or a loss that no radio measures.
    pub unusable: usize,
    /// Where the plane touches the Earth, if places were read by latitude and longitude.
    pub origin: Option<Origin>,
}

/// What was heard of a transmitter.
#[derive(Debug, Clone, PartialEq)]
pub struct Heard {
    /// As the log names it.
    pub name: String,
    /// In the order of their times.
    pub stops: Vec<Stop>,
}

/// From stop to stop it takes so long, s.
const USUAL_STEP_S: [f64; 2] = [2e-2, 60.0];
/// Reads columns t,x,y,h, or t,lat,lon,h, and `path_loss_db` or `rssi_db`; or levels with places in a ROS 1 bag or MCAP. Of
/// several transmitters, which a column user names, `--topic` says which one is meant, or all are. The drone's heading
/// (degrees clockwise from y, north) is taken where there is a column of it.
///
/// # Errors
/// The file, the line, and what was expected there.
pub fn read(path: &Path, options: &Options) -> Result<(Flight, Found), Error> {
    let bytes = text::bytes(path)?;
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
            // An empty field means that no measurement came.
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
    Ok((flight, found))
}

impl Flight {
    /// Of nothing measured.
    pub fn new(quantity: Quantity) -> Self {
        let (stops, others) = (Vec::new(), Vec::new());
        Self { quantity, stops, transmitter: None, others, unusable: 0, origin: None }
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
    /// Time, height, and what was measured.
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
