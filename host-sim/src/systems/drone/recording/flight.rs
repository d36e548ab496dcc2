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
    /// Rows that no channel can use: without height, or a loss that no radio measures.
    pub unusable: usize,
    /// Where the plane touches the Earth, if places were read by latitude and longitude.
    pub origin: Option<Origin>,
}

/// From stop to stop it takes so long, s.
const USUAL_STEP_S: [f64; 2] = [2e-2, 60.0];
/// Reads columns t,x,y,h, or t,lat,lon,h, and `path_loss_db` or `rssi_db`; or levels with places in a ROS 1 bag or MCAP. Of
/// several transmitters, which a column user names, the one that `--topic` says.
///
/// # Errors
/// The file, the line, and what was expected there.
pub fn read(path: &Path, options: &Options) -> Result<(Flight, Found), Error> {
    let bytes = text::bytes(path)?;
    let levels = levels::read(&bytes, options).map_err(|error| table::refused(path, &error))?;
    if let Some(levels) = levels {
        return Ok(of_levels(levels));
    }
    let mut flight =
        Flight { quantity: Quantity::PathLoss, stops: Vec::new(), unusable: 0, origin: None };
    let mut users = Users::new(options.topic.as_deref());
    let mut found = table::parse(
        path,
        &bytes,
        &Log { what: "a recorded flight", usual_step_s: Some(USUAL_STEP_S), options },
        columns,
        |&(places, [t, h, value], quantity, user), row| {
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
            if user.is_some_and(|user| !users.hear(&row.text(user))) {
                return Ok(());
            }
            let stop = Stop { t, place, height, loss };
            if stop.is_usable() {
                flight.stops.push(stop);
            } else {
                flight.unusable += 1;
            }
            Ok(())
        },
    )?;
    found.import.extend(users.decided(path)?);
    flight.stops.sort_by(|a, b| a.t.total_cmp(&b.t));
    Ok((flight, found))
}

fn of_levels(levels: levels::Levels) -> (Flight, Found) {
    let quantity = if levels.are_losses { Quantity::PathLoss } else { Quantity::Level };
    let mut flight = Flight { quantity, stops: Vec::new(), unusable: 0, origin: None };
    for heard in levels.heard {
        let loss = if levels.are_losses { heard.level } else { -heard.level };
        let place = Origin::place(&mut flight.origin, heard.latitude, heard.longitude);
        let t = heard.time_us as f64 * 1e-6;
        let stop = place.map(|place| Stop { t, place, height: heard.height, loss });
        match stop.filter(Stop::is_usable) {
            Some(stop) => flight.stops.push(stop),
            None => flight.unusable += 1,
        }
    }
    (flight, Found { import: levels.conclusions, warnings: levels.damage.sentences() })
}

fn columns(header: &Header<'_>) -> Result<(Places, [Column; 3], Quantity, Option<Column>), Error> {
    let (places, user) = (Places::find(header)?, header.find("user")?);
    if header.find("path_loss_db")?.is_some() {
        let columns = header.require(["t", "h", "path_loss_db"])?;
        return Ok((places, columns, Quantity::PathLoss, user));
    }
    Ok((places, header.require(["t", "h", "rssi_db"])?, Quantity::Level, user))
}

/// Reads the user's true place: columns x,y or lat,lon as in the log, one line.
///
/// # Errors
/// The file, the line, and what was expected there.
pub fn read_truth(path: &Path, mut origin: Option<Origin>) -> Result<[f64; 2], Error> {
    let mut places = Vec::new();
    table::read(
        path,
        "the user's place",
        move |header| Places::find(header)?.as_in_log(header, origin),
        |columns, row| {
            if !places.is_empty() {
                return Err(row.line.error("expected one place, found a second one"));
            }
            places.push(columns.read(row, &mut origin)?);
            Ok(())
        },
    )?;
    Ok(places.first().copied().unwrap_or_default())
}
