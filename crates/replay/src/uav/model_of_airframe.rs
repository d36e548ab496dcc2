//! What a file of a model leaves out, from an aircraft's published coefficients.

use kestirim_uav_longitudinal::{Airframe, SpecificForce, SteadyFlight};
use serde::Deserialize;

use super::model_file::{Affine, Bias, Gusts, ModelFile, Trim};
use super::{ModelFileError, STATE_COLUMNS};

/// What is usually measured.
const USUAL: [&str; 4] = ["q", "V", "theta", "az"];
/// Specific forces along the body's axes, beside the states.
const FORCES: [&str; 2] = ["ax", "az"];
/// Published coefficients are wrong by such a part, …
const WRONG: f64 = 0.1;
/// … which shows in deviations of states and inputs of this size …
const DEVIATIONS: [f64; 6] = [0.03, 0.1, 1.0, 0.05, 0.03, 0.1];
/// … that last so long, s.
const LASTING: f64 = 0.5;
/// What θ̇ is off by rounding and filtering, rad²/s.
const PITCH: f64 = 1e-8;
/// Light turbulence: deviations (m/s) and lengths (m) along and across. `replay` tries stronger and weaker.
const GUST: Gusts = Gusts { sigma_u: 1.0, sigma_w: 1.0, length_u: 200.0, length_w: 50.0 };
/// The trim is another one than computed, of ẋ; that of α̇ is of a lift that is wrong by a part.
const AFFINE: Affine = Affine { sigma: [0.0, 0.5, 0.3, 0.0], rate: [1e-3, 1e-3, 0.02, 0.0] };
/// Errors of a gyro and a pitch angle, and how an accelerometer's walks.
const GYRO: [f64; 2] = [0.02, 1e-5];
const PITCH_ANGLE: [f64; 2] = [0.03, 1e-5];
const ACCELEROMETER_RATE: f64 = 0.01;
/// Where it is mounted, a pitot tube measures such a part of the airspeed too much or too little, and this walks, m/s per √s.
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
    /// Its size and coefficients.
    pub fn airframe(self) -> Airframe {
        match self {
            Self::Aerosonde => Airframe::aerosonde(),
            Self::SkywalkerX8 => Airframe::skywalker_x8(),
        }
    }
}

impl ModelFile {
    /// Trim, A, B, C, D and noise of an aircraft in a steady flight. What the file says itself stands.
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
        // A lift that is wrong all the time shows in the trim, and beside an accelerometer's own error.
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
        // Drag goes with the square of the airspeed, but thrust does not: ax is not in proportion.
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

/// C, D and what is shown in the steady flight.
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
