//! Recorded flights.

use std::path::Path;

use kestirim_import::Options;

use crate::Error;
use crate::table::{self, Column, Found, Header, Log};

/// What was measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Path loss, dB.
    PathLoss,
    /// Received level of unknown offset, dB.
    Level,
}

/// One measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// s.
    pub t: f64,
    /// Where the drone was, m.
    pub place: [f64; 2],
    /// Its height above the user, m.
    pub height: f64,
    /// The path loss, or the negative level, dB.
    pub loss: f64,
}

/// A log.
#[derive(Debug, Clone, PartialEq)]
pub struct Flight {
    /// What was measured.
    pub quantity: Quantity,
    /// In the order of their times.
    pub stops: Vec<Stop>,
    /// Rows that no channel can use: without height, or a loss that no radio measures.
    pub unusable: usize,
}

/// From stop to stop it takes less, s.
const LONGEST_STEP_S: f64 = 60.0;
/// Heights above which no drone flies, m.
const HIGHEST_M: f64 = 20_000.0;
/// No radio measures a larger loss or level, dB.
const LARGEST_DB: f64 = 300.0;

impl Stop {
    /// Whether a channel can use it.
    pub fn is_usable(&self) -> bool {
        self.height > 0.0 && self.height < HIGHEST_M && self.loss.abs() <= LARGEST_DB
    }
}

/// Reads columns t,x,y,h and `path_loss_db` or `rssi_db`.
///
/// # Errors
/// The file, the line, and what was expected there.
pub fn read(path: &Path, options: &Options) -> Result<(Flight, Found), Error> {
    let mut flight = Flight { quantity: Quantity::PathLoss, stops: Vec::new(), unusable: 0 };
    let found = table::read_log(
        path,
        &Log { what: "a recorded flight", longest_step_s: Some(LONGEST_STEP_S), options },
        columns,
        |&([t, x, y, h, value], quantity), row| {
            flight.quantity = quantity;
            let t = row.time_us(t)? as f64 * 1e-6;
            let place = [row.coordinate("x", x)?, row.coordinate("y", y)?];
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
            let stop = Stop { t, place, height, loss };
            if stop.is_usable() {
                flight.stops.push(stop);
            } else {
                flight.unusable += 1;
            }
            Ok(())
        },
    )?;
    flight.stops.sort_by(|a, b| a.t.total_cmp(&b.t));
    Ok((flight, found))
}

fn columns(header: &Header<'_>) -> Result<([Column; 5], Quantity), Error> {
    if header.find("path_loss_db")?.is_some() {
        return Ok((header.require(["t", "x", "y", "h", "path_loss_db"])?, Quantity::PathLoss));
    }
    Ok((header.require(["t", "x", "y", "h", "rssi_db"])?, Quantity::Level))
}

/// Reads the user's true place: columns x,y, one line.
///
/// # Errors
/// The file, the line, and what was expected there.
pub fn read_truth(path: &Path) -> Result<[f64; 2], Error> {
    let mut places = Vec::new();
    table::read(
        path,
        "the user's place",
        |header| header.require(["x", "y"]),
        |&[x, y], row| {
            if !places.is_empty() {
                return Err(row.line.error("expected one place, found a second one"));
            }
            places.push([row.coordinate("x", x)?, row.coordinate("y", y)?]);
            Ok(())
        },
    )?;
    Ok(places.first().copied().unwrap_or_default())
}
