//! Models in files.

use kestirim_observer_design::Discrete;
use kestirim_uav_estimator::{Drift, Dynamics};
use kestirim_uav_longitudinal::{Airframe, StateSpace, SteadyFlight};
use nalgebra::SMatrix;
use serde::Deserialize;

use super::model_grid::{ALONE, Airspeeds, Member};
use super::model_of_airframe::KnownAirframe;
use super::{Extended, MOST_EXTENDED_OUTPUTS, MOST_OUTPUTS, Model, STATE_COLUMNS, state_outputs};

/// The columns of a log whose names no output can have.
const TAKEN: [&str; 3] = ["t", "delta_e", "delta_t"];
/// The largest number of biases, in addition to head wind and density, that the filter has room for.
const MOST_BIASES: usize = 4;

/// Why a file does not hold a model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelFileError {
    /// Names of outputs and rows of C do not match.
    #[error(
        "expected outputs, the names of as many columns as C has rows (none are needed without C, or if C has four rows)"
    )]
    Outputs,
    /// There is no output, or there are too many.
    #[error("expected one to {most} outputs, found {found}")]
    Count {
        /// The largest possible number.
        most: usize,
        /// The number found.
        found: usize,
    },
    /// A name occurs twice, or is that of another column.
    #[error("expected each output to be one column of the log, and once; found {}", printable(.0))]
    Taken(String),
    /// The interval of a discrete-time model is not above zero.
    #[error("expected an h above 0 s, found {}", printable(&.0.to_string()))]
    Interval(f64),
    /// The length of a list is not the number of outputs.
    #[error("expected {expected} numbers in {field}, one an output, found {found}")]
    Length {
        /// The name of the list.
        field: &'static str,
        /// The number of outputs.
        expected: usize,
        /// The number of entries in the list.
        found: usize,
    },
    /// A name is not that of an output.
    #[error("expected the names of outputs in {field}, found {}", printable(.name))]
    Unknown {
        /// The field in which it stands.
        field: &'static str,
        /// The name.
        name: String,
    },
    /// An airframe has no steady flight as requested.
    #[error("{0}: no steady flight of this airframe")]
    Airframe(String),
    /// A number or a combination of fields is invalid.
    #[error("expected {0}")]
    Number(&'static str),
}

/// A piece of a file, shortened and on one line.
fn printable(text: &str) -> String {
    const LONGEST: usize = 24;
    let start: String = text.chars().take(LONGEST).collect();
    let dots = if text.chars().nth(LONGEST).is_some() { "…" } else { "" };
    if text.is_empty() {
        "nothing".to_owned()
    } else {
        format!("\"{}{dots}\"", start.escape_debug())
    }
}

/// A model as in a JSON file: A, B and perhaps C, outputs, trim {x, u} and h, or an airframe and its airspeed; and
/// whatever else is known.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ModelFile {
    pub(super) airframe: Option<KnownAirframe>,
    pub(super) coefficients: Option<Box<Airframe>>,
    pub(super) airspeed: Option<Airspeeds>,
    climb_angle: Option<f64>,
    #[serde(rename = "A")]
    pub(super) a: Option<[[f64; 4]; 4]>,
    #[serde(rename = "B")]
    pub(super) b: Option<[[f64; 2]; 4]>,
    #[serde(rename = "C")]
    pub(super) c: Option<Vec<[f64; 4]>>,
    #[serde(rename = "D")]
    pub(super) d: Option<Vec<[f64; 2]>>,
    pub(super) outputs: Option<Vec<String>>,
    pub(super) trim: Option<Trim>,
    h: Option<f64>,
    grid: Option<Vec<Member>>,
    pub(super) noise: Option<Noise>,
    pub(super) bias: Option<Vec<Bias>>,
    pub(super) gust: Option<Gusts>,
    wind: Option<Drifting>,
    density: Option<Drifting>,
    /// The airspeed of the middle model of a grid, m/s: all models of a grid have the same biases.
    #[serde(skip)]
    pub(super) usual_airspeed: Option<f64>,
    pub(super) affine: Option<Affine>,
    pub(super) scaled: Option<Vec<String>>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct Trim {
    pub(super) x: [f64; 4],
    pub(super) u: [f64; 2],
    pub(super) y: Option<Vec<f64>>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
pub(super) struct Noise {
    pub(super) process: Option<[f64; 4]>,
    pub(super) process_matrix: Option<[[f64; 4]; 4]>,
    inputs: Option<[f64; 2]>,
    outputs: Option<Vec<f64>>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct Bias {
    pub(super) of: String,
    pub(super) sigma: f64,
    #[serde(default)]
    pub(super) rate: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
struct Drifting {
    sigma: f64,
    #[serde(default)]
    rate: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub(super) struct Gusts {
    pub(super) sigma_u: f64,
    pub(super) sigma_w: f64,
    pub(super) length_u: f64,
    pub(super) length_w: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub(super) struct Affine {
    pub(super) sigma: [f64; 4],
    #[serde(default)]
    pub(super) rate: [f64; 4],
}

impl ModelFile {
    /// Builds the model.
    ///
    /// # Errors
    /// A [`ModelFileError`] that says what was expected, and what was found.
    pub fn model(mut self) -> Result<Model, ModelFileError> {
        if self.airframe.is_some() && self.coefficients.is_some() {
            return Err(ModelFileError::Number("airframe or coefficients, found both"));
        }
        let models = match (self.grid.take(), self.airspeed.take()) {
            (Some(members), None) => self.of_members(members)?,
            (None, Some(Airspeeds::Grid(airspeeds))) => self.of_airspeeds(&airspeeds)?,
            (None, airspeed) => {
                self.airspeed = airspeed;
                return self.one(false);
            }
            (Some(_), Some(_)) => return Err(ModelFileError::Number(ALONE)),
        };
        // Deviations are smallest if they are counted from the middle model.
        let mut model = models[models.len() / 2].clone();
        if let Some(extended) = &mut model.extended {
            extended.grid = models;
        }
        Ok(model)
    }

    pub(super) fn says_matrices(&self) -> bool {
        let is_there = [
            self.a.is_some(),
            self.b.is_some(),
            self.c.is_some(),
            self.d.is_some(),
            self.trim.is_some(),
            self.h.is_some(),
        ];
        is_there.contains(&true)
    }

    /// Builds the model of one airspeed.
    pub(super) fn one(mut self, is_of_grid: bool) -> Result<Model, ModelFileError> {
        let known = self.airframe.take().map(KnownAirframe::airframe);
        if let Some(airframe) = self.coefficients.take().map(|it| *it).or(known) {
            let alone = self.airspeed.take().filter(|_| !self.says_matrices());
            let Some(Airspeeds::One(airspeed)) = alone else {
                return Err(ModelFileError::Number(
                    "an airspeed beside airframe or coefficients, and no A, B, C, D, trim or h, which come from both",
                ));
            };
            let flight = SteadyFlight { airspeed, climb_angle: self.climb_angle.unwrap_or(0.0) };
            self = self.flown(&airframe, &flight)?;
        }
        let (Some(a), Some(b)) = (self.a, self.b) else {
            return Err(ModelFileError::Number(
                "A and B, or an airspeed and airframe or coefficients",
            ));
        };
        let outputs = self.outputs()?;
        let extended = self.extended(&outputs, is_of_grid)?;
        let most = if extended.is_some() { MOST_EXTENDED_OUTPUTS } else { MOST_OUTPUTS };
        if outputs.is_empty() || outputs.len() > most {
            return Err(ModelFileError::Count { most, found: outputs.len() });
        }
        for (place, (name, _)) in outputs.iter().enumerate() {
            let twice = outputs.iter().take(place).any(|(other, _)| other == name);
            if twice || TAKEN.contains(&name.as_str()) {
                return Err(ModelFileError::Taken(name.clone()));
            }
        }
        let a = SMatrix::<f64, 4, 4>::from(a).transpose();
        let b = SMatrix::<f64, 2, 4>::from(b).transpose();
        let dynamics = match self.h {
            None => Dynamics::Continuous(StateSpace { a, b }),
            Some(_) if extended.is_some() => {
                return Err(ModelFileError::Number(
                    "A and B of continuous time, without h, beside what is more than A, B, C and outputs",
                ));
            }
            Some(interval) if interval > 0.0 => {
                Dynamics::Discrete { step: Discrete { a, b }, interval }
            }
            Some(interval) => return Err(ModelFileError::Interval(interval)),
        };
        let trim = self.trim.map(|trim| (trim.x, trim.u));
        Ok(Model { dynamics, outputs, trim, extended: extended.map(Box::new) })
    }

    /// The names of the outputs and the rows of C.
    fn outputs(&self) -> Result<Vec<(String, [f64; 4])>, ModelFileError> {
        match (&self.c, &self.outputs) {
            (None, None) => Ok(state_outputs()),
            (Some(rows), Some(names)) if rows.len() == names.len() => {
                Ok(names.iter().cloned().zip(rows.iter().copied()).collect())
            }
            (Some(rows), None) if rows.len() == STATE_COLUMNS.len() => {
                Ok(STATE_COLUMNS.map(str::to_owned).into_iter().zip(rows.iter().copied()).collect())
            }
            _ => Err(ModelFileError::Outputs),
        }
    }

    /// The part beyond what every model describes; `None` if there is nothing of it and it is not required.
    fn extended(
        &self,
        outputs: &[(String, [f64; 4])],
        is_wanted: bool,
    ) -> Result<Option<Extended>, ModelFileError> {
        let steady = self.trim.as_ref().and_then(|trim| trim.y.as_ref());
        let is_there = [
            self.d.is_some(),
            steady.is_some(),
            self.noise.is_some(),
            self.bias.is_some(),
            self.gust.is_some(),
            self.wind.is_some(),
            self.density.is_some(),
            self.affine.is_some(),
            self.scaled.is_some(),
        ];
        if !is_wanted && !is_there.contains(&true) {
            return Ok(None);
        }
        let count = outputs.len();
        let as_many = |field, found: usize| {
            let wrong = ModelFileError::Length { field, expected: count, found };
            if found == count { Ok(()) } else { Err(wrong) }
        };
        let trim = self.trim.as_ref().map_or([0.0; 4], |trim| trim.x);
        let shown = |(_, row): &(String, [f64; 4])| -> f64 {
            row.iter().zip(trim).map(|(part, state)| part * state).sum()
        };
        let steady = steady.cloned().unwrap_or_else(|| outputs.iter().map(shown).collect());
        as_many("trim.y", steady.len())?;
        let direct = self.d.clone().unwrap_or_else(|| vec![[0.0; 2]; count]);
        as_many("D", direct.len())?;
        let noise = self.noise.as_ref();
        let sigmas = noise.and_then(|noise| noise.outputs.clone());
        if let Some(sigmas) = &sigmas {
            as_many("noise.outputs", sigmas.len())?;
            if !sigmas.iter().all(|sigma| *sigma > 0.0) {
                return Err(ModelFileError::Number("noise.outputs above 0"));
            }
        }
        let place = |field, name: &String| {
            let unknown = || ModelFileError::Unknown { field, name: name.clone() };
            outputs.iter().position(|(known, _)| known == name).ok_or_else(unknown)
        };
        let mut scaled = vec![false; count];
        for name in self.scaled.iter().flatten() {
            scaled[place("scaled", name)?] = true;
        }
        let biases = self.bias.iter().flatten().map(|Bias { of, sigma, rate }| {
            Ok((place("bias", of)?, Drift { sigma: *sigma, rate: *rate }))
        });
        let biases = biases.collect::<Result<Vec<_>, _>>()?;
        if biases.len() > MOST_BIASES {
            return Err(ModelFileError::Number("no more than four biases"));
        }
        if let Some(process) = noise.and_then(Noise::density) {
            let is_covariance = process == process.transpose()
                && process.symmetric_eigenvalues().min() >= -1e-9 * process.norm();
            if !is_covariance {
                return Err(ModelFileError::Number(
                    "a process noise that is symmetric and nowhere negative",
                ));
            }
        }
        let is_trimmed = self.trim.as_ref().is_some_and(|trim| trim.x[2] > 0.0);
        if !is_trimmed && (self.gust.is_some() || scaled.contains(&true)) {
            return Err(ModelFileError::Number("a trim with an airspeed beside gust or scaled"));
        }
        if self.gust.is_some_and(|gust| !(gust.length_u > 0.0 && gust.length_w > 0.0)) {
            return Err(ModelFileError::Number("lengths of gusts above 0 m"));
        }
        let forces = self.affine.map_or_else(Vec::new, |Affine { sigma, rate }| {
            let drifts = (0..4).map(|state| Drift { sigma: sigma[state], rate: rate[state] });
            drifts.enumerate().filter(|(_, drift)| drift.sigma > 0.0 || drift.rate > 0.0).collect()
        });
        Ok(Some(Extended {
            direct,
            steady,
            scaled,
            process: noise.and_then(Noise::density),
            inputs: noise.and_then(|noise| noise.inputs),
            sigmas,
            biases,
            gust: self.gust.map(|it| ([it.sigma_u, it.sigma_w], [it.length_u, it.length_w])),
            wind: self.wind.map(Drifting::drift),
            density: self.density.map(Drifting::drift),
            forces,
            grid: Vec::new(),
        }))
    }
}

impl Drifting {
    const fn drift(self) -> Drift {
        Drift { sigma: self.sigma, rate: self.rate }
    }
}

impl Noise {
    /// The spectral density of white noise on ẋ.
    fn density(&self) -> Option<SMatrix<f64, 4, 4>> {
        match (self.process, self.process_matrix) {
            (_, Some(rows)) => Some(SMatrix::<f64, 4, 4>::from(rows).transpose()),
            (Some(diagonal), None) => Some(SMatrix::from_diagonal(&diagonal.into())),
            (None, None) => None,
        }
    }
}
