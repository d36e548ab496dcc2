//! The model of an aircraft from a file.

use std::path::Path;

use kestirim_observer_design::Discrete;
use kestirim_replay::uav::{MOST_OUTPUTS, Model, STATE_COLUMNS, state_outputs};
use kestirim_uav_estimator::Dynamics;
use kestirim_uav_longitudinal::StateSpace;
use nalgebra::SMatrix;
use serde::Deserialize;

use crate::Error;
use crate::text::{TextFile, printable};

/// Columns of a log that no output can have.
const TAKEN: [&str; 3] = ["t", "delta_e", "delta_t"];
/// A model file.
#[derive(Debug, Deserialize)]
struct Contents {
    #[serde(rename = "A")]
    a: [[f64; 4]; 4],
    #[serde(rename = "B")]
    b: [[f64; 2]; 4],
    #[serde(rename = "C")]
    c: Option<Vec<[f64; 4]>>,
    outputs: Option<Vec<String>>,
    trim: Option<Trim>,
    h: Option<f64>,
}

#[derive(Debug, Deserialize)]
struct Trim {
    x: [f64; 4],
    u: [f64; 2],
}

/// What is in a file.
///
/// # Errors
/// The file, the line, and what was expected there.
pub fn read(path: &Path) -> Result<Model, Error> {
    let file = TextFile::read(path)?;
    let contents: Contents =
        file.json("a JSON object with A, B and perhaps C, outputs, trim and h")?;
    let outputs = match (contents.c, contents.outputs) {
        (None, None) => state_outputs(),
        (Some(rows), Some(names)) if rows.len() == names.len() => {
            names.into_iter().zip(rows).collect()
        }
        (Some(rows), None) if rows.len() == STATE_COLUMNS.len() => {
            STATE_COLUMNS.map(str::to_owned).into_iter().zip(rows).collect()
        }
        _ => {
            return Err(file.error(
                "expected outputs, the names of as many columns as C has rows (none are needed \
                 without C, or if C has four rows)",
            ));
        }
    };
    if outputs.is_empty() || outputs.len() > MOST_OUTPUTS {
        let count = outputs.len();
        return Err(file.error(format!("expected one to {MOST_OUTPUTS} outputs, found {count}")));
    }
    for (place, (name, _)) in outputs.iter().enumerate() {
        let twice = outputs.iter().take(place).any(|(other, _)| other == name);
        if twice || TAKEN.contains(&name.as_str()) {
            let name = printable(name);
            return Err(
                file.error(format!("expected names of outputs that are free, found {name}"))
            );
        }
    }
    let a = SMatrix::<f64, 4, 4>::from(contents.a).transpose();
    let b = SMatrix::<f64, 2, 4>::from(contents.b).transpose();
    let dynamics = match contents.h {
        None => Dynamics::Continuous(StateSpace { a, b }),
        Some(interval) if interval > 0.0 => {
            Dynamics::Discrete { step: Discrete { a, b }, interval }
        }
        Some(interval) => {
            let found = printable(&interval.to_string());
            return Err(file.error(format!("expected an h above 0 s, found {found}")));
        }
    };
    Ok(Model { dynamics, outputs, trim: contents.trim.map(|trim| (trim.x, trim.u)) })
}
