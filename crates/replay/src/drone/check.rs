//! Checks of a recorded flight before the user is searched for.

use kestirim_health::Reason;

use super::{Quantity, Stop};
use crate::Finding;
use crate::metrics::{median, standard_deviation};

/// The number of measurements in a row with the same level, to the last digit, while the drone moves, from which on the
/// radio is stuck.
const STUCK: usize = 8;

/// The findings about the measurements, of which `unusable` lines had to be left out.
pub fn check(stops: &[Stop], quantity: Quantity, unusable: usize) -> Vec<Finding> {
    let heights: Vec<f64> = stops.iter().map(|stop| stop.height).collect();
    let losses: Vec<f64> = stops.iter().map(|stop| stop.loss).collect();
    let far = |axis: usize| {
        let along = stops.iter().map(|stop| stop.place[axis]);
        along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
    };
    let what = match quantity {
        Quantity::PathLoss => "path losses",
        Quantity::Level => "levels",
    };
    let mut findings = vec![
        Finding::note(
            "measurements",
            format!("{} {what} over {:.0} m × {:.0} m", stops.len(), far(0), far(1)),
        ),
        Finding::note("height", format!("{:.0} m usually", median(&heights))),
        Finding::note(
            "spread",
            format!("the {what} vary by {:.1} dB", standard_deviation(&losses)),
        ),
    ];
    if unusable > 0 {
        let found = format!("{unusable} lines without a height or a level");
        findings.push(Finding::note("missing", found));
    }
    // A received level, of −30 to −140 dBm, given as a path loss.
    let positive = losses.iter().filter(|loss| **loss < 0.0).count();
    if quantity == Quantity::PathLoss && positive * 2 > losses.len() {
        findings.push(Finding::fault(
            "sign",
            Reason::Units,
            "most path losses are below zero",
            "the user is placed where the signal is weakest",
            "a path loss is above zero; received levels belong into a column rssi_db",
        ));
    }
    let runs = stops.chunk_by(|a, b| a.loss == b.loss && a.place != b.place);
    let longest = runs.map(<[_]>::len).max().unwrap_or(0);
    if longest >= STUCK {
        findings.push(Finding::fault(
            "stuck",
            Reason::Stuck,
            format!("{longest} measurements in a row are the same to the last digit"),
            "they say nothing of where the user is",
            "look at how the radio reports its level",
        ));
    }
    findings
}
