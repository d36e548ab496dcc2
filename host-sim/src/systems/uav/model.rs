//! The model of a replay: one of the plants, or a file.

use std::path::Path;

use kestirim_observer_design::{Discrete, discrete_noise, zero_order_hold};
use kestirim_uav_longitudinal::{Airframe, SteadyFlight};
use nalgebra::{SMatrix, SVector};
use serde::Deserialize;

use super::plant::Plant;
use crate::Error;
use crate::text::{TextFile, printable};

/// Names of the states, which are the columns of a log where a model has no C.
pub const STATE_COLUMNS: [&str; 4] = ["alpha", "q", "V", "theta"];
/// Steps of a discrete model that an interval of a log may take.
const MOST_STEPS: f64 = 1e5;
/// Columns of a log that no output can have.
const TAKEN: [&str; 3] = ["t", "delta_e", "delta_t"];
/// More outputs than states say nothing new.
const MOST_OUTPUTS: usize = 4;

/// What an estimator needs to know of an aircraft.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    dynamics: Dynamics,
    /// What could be measured: a column of the log, and its row of C.
    pub outputs: Vec<(String, [f64; 4])>,
    /// State and input of the flight that deviations are counted from.
    pub trim: Option<([f64; 4], [f64; 2])>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Dynamics {
    Continuous { a: SMatrix<f64, 4, 4>, b: SMatrix<f64, 4, 2> },
    Discrete { step: Discrete<4, 2>, interval: f64 },
}

/// What a model does in an interval: transition, and covariance of the noise.
pub type Step = (Discrete<4, 2>, SMatrix<f64, 4, 4>);

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
    /// P1, P2, P3, or what is in a file.
    ///
    /// # Errors
    /// The file, the line, and what was expected there.
    pub fn read(name: &Path) -> Result<Self, Error> {
        match name.to_str() {
            Some("P1") => Ok(Self { trim: Some(climb()), ..Self::of(Plant::P1) }),
            Some("P2") => Ok(Self::of(Plant::P2)),
            Some("P3") => Ok(Self::of(Plant::P3)),
            _ => Self::from_file(name),
        }
    }

    fn of(plant: Plant) -> Self {
        let model = plant.model();
        let dynamics = Dynamics::Continuous { a: model.a, b: model.b };
        Self { dynamics, outputs: states(), trim: None }
    }

    fn from_file(path: &Path) -> Result<Self, Error> {
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
            None => Dynamics::Continuous { a, b },
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

    /// What happens in `interval` seconds, where white noise of these standard deviations a `sample` (s) reaches
    /// the inputs.
    ///
    /// # Errors
    /// In words: why it does not happen.
    pub fn over(&self, interval: f64, sample: f64, noise: [f64; 2]) -> Result<Step, String> {
        let variances = SMatrix::from_diagonal(&SVector::from(noise.map(|sigma| sigma * sigma)));
        match self.dynamics {
            Dynamics::Continuous { a, b } => {
                let density = b * variances * b.transpose() * sample;
                let transition = zero_order_hold(&a, &b, interval).map_err(|e| e.to_string())?;
                let noise = discrete_noise(&a, &density, interval).map_err(|e| e.to_string())?;
                Ok((transition, noise))
            }
            Dynamics::Discrete { step, interval: own } => {
                let count = (interval / own).round();
                if !(1.0..=MOST_STEPS).contains(&count)
                    || (interval - count * own).abs() > 0.1 * own
                {
                    return Err(format!(
                        "the model is for intervals of {own} s, the log has one of {interval} s"
                    ));
                }
                let mut all = Discrete { a: SMatrix::identity(), b: SMatrix::zeros() };
                let mut spread = SMatrix::zeros();
                let once = step.b * variances * step.b.transpose();
                for _ in 0..count as u64 {
                    all = Discrete { a: step.a * all.a, b: step.a * all.b + step.b };
                    spread = step.a * spread * step.a.transpose() + once;
                }
                Ok((all, spread))
            }
        }
    }
}

/// State and input of P1's flight.
pub(super) fn climb() -> ([f64; 4], [f64; 2]) {
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
