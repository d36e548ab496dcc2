//! Grids of models: several airspeeds in one file.

use serde::Deserialize;

use super::augmented::MOST_MODELS;
use super::model_file::{ModelFile, Trim};
use super::{Model, ModelFileError};

/// The error for a file with fields that cannot be combined with a grid.
pub(super) const ALONE: &str = "a grid alone, where each model has its A, B, C, D and trim: without those, h, airframe, coefficients and airspeed beside it";

/// One airspeed, or those of a grid, m/s.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged, expecting = "expected an airspeed in m/s or a list of them")]
pub(super) enum Airspeeds {
    One(f64),
    Grid(Vec<f64>),
}

/// The fields of a file that each model of a grid has itself.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct Member {
    #[serde(rename = "A")]
    a: [[f64; 4]; 4],
    #[serde(rename = "B")]
    b: [[f64; 2]; 4],
    #[serde(rename = "C")]
    c: Option<Vec<[f64; 4]>>,
    #[serde(rename = "D")]
    d: Option<Vec<[f64; 2]>>,
    trim: Option<Trim>,
    h: Option<f64>,
}

impl ModelFile {
    /// Builds the models of a grid that are written out in the file.
    pub(super) fn of_members(&self, members: Vec<Member>) -> Result<Vec<Model>, ModelFileError> {
        if self.airframe.is_some() || self.coefficients.is_some() || self.says_matrices() {
            return Err(ModelFileError::Number(ALONE));
        }
        let models = members.into_iter().map(|Member { a, b, c, d, trim, h }| {
            if trim.is_none() {
                return Err(ModelFileError::Number("a trim with x and u in each model of a grid"));
            }
            if h.is_some() {
                return Err(ModelFileError::Number(
                    "A and B of continuous time, without h, in each model of a grid",
                ));
            }
            let mut file = self.clone();
            (file.a, file.b, file.c, file.d, file.trim) = (Some(a), Some(b), c, d, trim);
            file.one(true)
        });
        let models = models.collect::<Result<Vec<_>, _>>()?;
        let airspeeds = models.iter().filter_map(|model| model.trim.map(|(state, _)| state[2]));
        rising(&airspeeds.collect::<Vec<_>>())?;
        Ok(models)
    }

    /// Builds the models of an airframe at the given airspeeds.
    pub(super) fn of_airspeeds(&self, airspeeds: &[f64]) -> Result<Vec<Model>, ModelFileError> {
        rising(airspeeds)?;
        let models = airspeeds.iter().map(|&airspeed| {
            let mut file = self.clone();
            file.airspeed = Some(Airspeeds::One(airspeed));
            file.usual_airspeed = airspeeds.get(airspeeds.len() / 2).copied();
            file.one(true).map_err(|error| match error {
                ModelFileError::Airframe(why) => {
                    ModelFileError::Airframe(format!("at {airspeed} m/s {why}"))
                }
                other => other,
            })
        });
        models.collect()
    }
}

/// Checks that these can be the airspeeds of a grid.
fn rising(airspeeds: &[f64]) -> Result<(), ModelFileError> {
    let is_grid = (2..=MOST_MODELS).contains(&airspeeds.len())
        && airspeeds[0] > 0.0
        && airspeeds.windows(2).all(|pair| pair[0] < pair[1]);
    let wrong = ModelFileError::Number("a grid of 2 to 8 airspeeds above 0 m/s that rise");
    if is_grid { Ok(()) } else { Err(wrong) }
}
