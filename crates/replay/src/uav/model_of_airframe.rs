//! Completion of a model file from an aircraft's published coefficients.

use kestirim_uav_longitudinal::{Airframe, SpecificForce, SteadyFlight};
use serde::Deserialize;

use super::model_file::{Affine, Bias, Gusts, ModelFile, Trim};
use super::{ModelFileError, STATE_COLUMNS};

/// The outputs of a model that names none: what is usually measured.
const USUAL: [&str; 4] = ["q", "V", "theta", "az"];
/// The names of specific forces along the body's axes, which can be outputs in addition to the states.
const FORCES: [&str; 2] = ["ax", "az"];
/// The relative error of published coefficients.
const WRONG: f64 = 0.1;
/// The size of the deviations of states and inputs in which that error shows.
const DEVIATIONS: [f64; 6] = [0.03, 0.1, 1.0, 0.05, 0.03, 0.1];
/// The time for which such deviations last, s.
const LASTING: f64 = 0.5;
/// The process noise of θ̇ from rounding and filtering, rad²/s.
const PITCH: f64 = 1e-8;
/// Light turbulence: standard deviations (m/s) and lengths (m) along and across. `replay` tries stronger and weaker
/// gusts.
const GUST: Gusts = Gusts { sigma_u: 1.0, sigma_w: 1.0, length_u: 200.0, length_w: 50.0 };
/// Errors of the computed trim, as unknown parts of ẋ. That of α̇ is due to a lift that is wrong by `WRONG`, and is set
/// with the airspeed.
const AFFINE: Affine = Affine { sigma: [0.0, 0.5, 0.3, 0.0], rate: [1e-3, 1e-3, 0.02, 0.0] };
/// The biases of a gyro and of a pitch angle, and the rates at which they and an accelerometer's bias walk.
const GYRO: [f64; 2] = [0.02, 1e-5];
const PITCH_ANGLE: [f64; 2] = [0.03, 1e-5];
const ACCELEROMETER_RATE: f64 = 0.01;
/// The position error of a pitot tube, which measures a share of the airspeed too much or too little depending on its
/// mounting, and its random walk, m/s per √s.
const POSITION_ERROR: f64 = 0.03;
const POSITION_RATE: f64 = 1e-3;

/// An aircraft that is known by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum KnownAirframe {
    /// [`Airframe::aerosonde`].
    Aerosonde,
    /// [`Airframe::skywalker_x8`].
    SkywalkerX8,
}

impl KnownAirframe {
    /// The size and coefficients of the aircraft.
    pub fn airframe(self) -> Airframe {
        match self {
            Self::Aerosonde => Airframe::aerosonde(),
            Self::SkywalkerX8 => Airframe::skywalker_x8(),
        }
    }
}

impl ModelFile {
    /// Fills in trim, A, B, C, D and noise of an aircraft in a steady flight. What the file states itself remains.
    pub(super) fn flown(
        mut self,
        airframe: &Airframe,
        flight: &SteadyFlight,
    ) -> Result<Self, ModelFileError> {
        let refused =
            |error: kestirim_uav_longitudinal::Error| ModelFileError::Airframe(error.to_string());
        let trim = airframe.trim(flight).map_err(refused)?;
        let model = airframe.linearise(&trim).map_err(refused)?;
        let force = airframe.specific_force(&trim).map_err(refused)?;
        let names = self.outputs.clone();
        let names = names.unwrap_or_else(|| USUAL.map(str::to_owned).to_vec());
        let rows = names.iter().map(|name| row(name, &force, &trim.state.into()));
        let rows = rows.collect::<Result<Vec<_>, _>>()?;
        let is_there = |name: &str| names.iter().any(|other| other == name);
        // A constant error of the lift shows in the trim, and adds to an accelerometer's own error.
        let lift = WRONG * airframe.gravity;
        let airspeed = self.usual_airspeed.unwrap_or(flight.airspeed);
        let biases = [
            ("q", GYRO),
            ("theta", PITCH_ANGLE),
            ("az", [lift, ACCELEROMETER_RATE]),
            ("V", [POSITION_ERROR * airspeed, POSITION_RATE]),
        ];
        let biases = biases.into_iter().filter(|(of, _)| is_there(of));
        let biases = biases.map(|(of, [sigma, rate])| Bias { of: of.to_owned(), sigma, rate });
        let noise = self.noise.get_or_insert_default();
        if noise.process_matrix.is_none() {
            let [alpha, rate, airspeed, _] = model.process_noise(WRONG, &DEVIATIONS, LASTING);
            noise.process.get_or_insert([alpha, rate, airspeed, PITCH]);
        }
        self.bias.get_or_insert_with(|| biases.collect());
        self.gust.get_or_insert(GUST);
        let mut affine = AFFINE;
        affine.sigma[0] = lift / airspeed;
        self.affine.get_or_insert(affine);
        // Drag is proportional to the square of the airspeed, but thrust is not, so neither is ax.
        let scaled = || names.iter().filter(|name| *name == "az").cloned().collect();
        self.scaled.get_or_insert_with(scaled);
        self.a = Some(model.a.transpose().into());
        self.b = Some(model.b.transpose().into());
        self.c = Some(rows.iter().map(|(c, ..)| *c).collect());
        self.d = Some(rows.iter().map(|(_, d, _)| *d).collect());
        self.trim = Some(Trim {
            x: trim.state.into(),
            u: trim.input.into(),
            y: Some(rows.iter().map(|(.., y)| *y).collect()),
        });
        self.outputs = Some(names);
        Ok(self)
    }
}

/// A row of C, a row of D and the value in the steady flight.
type Row = ([f64; 4], [f64; 2], f64);

fn row(name: &str, force: &SpecificForce, steady: &[f64; 4]) -> Result<Row, ModelFileError> {
    if let Some(state) = STATE_COLUMNS.iter().position(|column| *column == name) {
        let unit = std::array::from_fn(|place| f64::from(u8::from(place == state)));
        return Ok((unit, [0.0; 2], steady[state]));
    }
    let axis = FORCES.iter().position(|other| *other == name).ok_or_else(|| {
        ModelFileError::Unknown { field: "outputs of an airframe", name: name.to_owned() }
    })?;
    let c = std::array::from_fn(|state| force.c[(axis, state)]);
    Ok((c, std::array::from_fn(|input| force.d[(axis, input)]), force.steady[axis]))
}
