//! The model of an aircraft: a known one's, or a file.

use std::path::Path;

use kestirim_observer_design::Discrete;
use kestirim_uav_estimator::Dynamics;
use kestirim_uav_longitudinal::{Airframe, StateSpace, SteadyFlight};
use nalgebra::SMatrix;
use serde::Deserialize;

use crate::Error;
use crate::systems::uav::simulate::plant::Plant;
use crate::text::{TextFile, printable};

/// Names of the states, which are the columns of a log where a model has no C.
pub const STATE_COLUMNS: [&str; 4] = ["alpha", "q", "V", "theta"];
/// Columns of a log that no output can have.
const TAKEN: [&str; 3] = ["t", "delta_e", "delta_t"];
/// More outputs than states say nothing new.
pub const MOST_OUTPUTS: usize = 4;

/// What `--absolute` does.
pub(in crate::systems::uav) const NEEDS_TRIM: &str =
    "needs a model with a trim: P1, or a file that has one";

/// What an estimator needs to know of an aircraft.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// How it flies.
    pub dynamics: Dynamics,
    /// What could be measured: a column of the log, and its row of C.
    pub outputs: Vec<(String, [f64; 4])>,
    /// State and input of the flight that deviations are counted from.
    pub trim: Option<([f64; 4], [f64; 2])>,
}

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

impl Model {
    /// Of a known aircraft.
    pub fn of(plant: Plant) -> Self {
        let dynamics = Dynamics::Continuous(plant.model());
        let trim = (plant == Plant::P1).then(climb);
        Self { dynamics, outputs: states(), trim }
    }

    /// What is in a file.
    ///
    /// # Errors
    /// The file, the line, and what was expected there.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let file = TextFile::read(path)?;
        let contents: Contents =
            file.json("a JSON object with A, B and perhaps C, outputs, trim and h")?;
        let outputs = match (contents.c, contents.outputs) {
            (None, None) => states(),
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
            return Err(
                file.error(format!("expected one to {MOST_OUTPUTS} outputs, found {count}"))
            );
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
        Ok(Self { dynamics, outputs, trim: contents.trim.map(|trim| (trim.x, trim.u)) })
    }

    /// What is taken from values: nothing, or of `absolute` ones the model's trim.
    ///
    /// # Errors
    /// [`Error::Usage`] if it has none.
    pub fn origin(&self, absolute: bool) -> Result<([f64; 4], [f64; 2]), Error> {
        match (absolute, self.trim) {
            (false, _) => Ok(([0.0; 4], [0.0; 2])),
            (true, Some(trim)) => Ok(trim),
            (true, None) => Err(Error::Usage(format!("--absolute {NEEDS_TRIM}"))),
        }
    }

    /// What an output measures of a state.
    pub fn output(&self, output: usize, state: &[f64; 4]) -> f64 {
        self.outputs[output].1.iter().zip(state).map(|(part, state)| part * state).sum()
    }
}

/// State and input of P1's flight.
pub(in crate::systems::uav) fn climb() -> ([f64; 4], [f64; 2]) {
    let flight = SteadyFlight { airspeed: 40.0, climb_angle: 4.0_f64.to_radians() };
    let trim = Airframe::aerosonde().trim(&flight).expect("the Aerosonde flies");
    (trim.state.into(), trim.input.into())
}

fn states() -> Vec<(String, [f64; 4])> {
    let unit = |state: usize| std::array::from_fn(|place| f64::from(u8::from(place == state)));
    STATE_COLUMNS
        .iter()
        .enumerate()
        .map(|(state, name)| ((*name).to_owned(), unit(state)))
        .collect()
}
