//! Models of aircraft.

use kestirim_observer_design::{Discrete, zero_order_hold};
use kestirim_uav_estimator::Dynamics;
use kestirim_uav_longitudinal::{self as aircraft, Airframe, StateSpace, SteadyFlight};

use super::{Error, Extended, Sample};

/// The names of the states, which are the columns of a log if a model has no C.
pub const STATE_COLUMNS: [&str; 4] = ["alpha", "q", "V", "theta"];
/// The largest number of outputs of a plain model: more outputs than states add nothing.
pub const MOST_OUTPUTS: usize = 4;

/// A known aircraft.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Plant {
    /// P1, the Aerosonde
    #[cfg_attr(feature = "clap", value(name = "P1"))]
    P1,
    /// P2, what the thesis says of its aircraft
    #[default]
    #[cfg_attr(feature = "clap", value(name = "P2"))]
    P2,
    /// P3, the Navion
    #[cfg_attr(feature = "clap", value(name = "P3"))]
    P3,
}

impl Plant {
    /// All known aircraft.
    pub const ALL: [Self; 3] = [Self::P1, Self::P2, Self::P3];

    /// The model in continuous time.
    ///
    /// # Panics
    /// Never: the known aircraft fly.
    pub fn model(self) -> StateSpace {
        match self {
            Self::P1 => aircraft::aerosonde().expect("the Aerosonde flies"),
            Self::P2 => aircraft::thesis_like(),
            Self::P3 => aircraft::navion(),
        }
    }

    /// The model in discrete time, with inputs that are held for `interval` seconds.
    ///
    /// # Panics
    /// The interval is not a number, or infinite.
    pub fn discrete(self, interval: f64) -> Discrete<4, 2> {
        let StateSpace { a, b } = self.model();
        zero_order_hold(&a, &b, interval).expect("finite matrices")
    }

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::P1 => "P1 Aerosonde",
            Self::P2 => "P2 thesis-like",
            Self::P3 => "P3 Navion",
        }
    }
}

/// What an estimator needs to know of an aircraft.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// The dynamics of the aircraft.
    pub dynamics: Dynamics,
    /// The outputs that can be measured: the name of the log's column, and the row of C.
    pub outputs: Vec<(String, [f64; 4])>,
    /// State and input of the steady flight from which deviations are counted.
    pub trim: Option<([f64; 4], [f64; 2])>,
    /// The extended part of the model, if it has one.
    pub extended: Option<Box<Extended>>,
}

impl Model {
    /// The model of a known aircraft.
    pub fn of(plant: Plant) -> Self {
        let dynamics = Dynamics::Continuous(plant.model());
        let trim = (plant == Plant::P1).then(climb);
        Self { dynamics, outputs: state_outputs(), trim, extended: None }
    }

    /// The state and input that are subtracted from values: zero, or the model's trim if values are `absolute`.
    ///
    /// # Errors
    /// [`Error::NoTrim`] if the model has none; [`Error::GridOfDeviations`] if it is a grid, and values are not
    /// `absolute`.
    pub fn origin(&self, absolute: bool) -> Result<([f64; 4], [f64; 2]), Error> {
        match (absolute, self.trim) {
            (false, _) if self.is_grid() => Err(Error::GridOfDeviations),
            (false, _) => Ok(([0.0; 4], [0.0; 2])),
            (true, Some(trim)) => Ok(trim),
            (true, None) => Err(Error::NoTrim),
        }
    }

    /// Whether the model belongs to a grid, between whose models a filter blends.
    pub fn is_grid(&self) -> bool {
        self.extended.as_ref().is_some_and(|extended| !extended.grid.is_empty())
    }

    /// The value of an output at this origin: its row of C applied to the origin, or for absolute values what the model
    /// states for its steady flight.
    pub fn shown(&self, output: usize, absolute: bool, origin: &[f64; 4]) -> f64 {
        match &self.extended {
            Some(extended) if absolute => extended.steady[output],
            _ => self.outputs[output].1.iter().zip(origin).map(|(part, state)| part * state).sum(),
        }
    }

    /// A sample without the direct contribution (D) of its inputs to these outputs.
    pub(super) fn without_direct(&self, sample: &Sample, outputs: &[usize]) -> Sample {
        let mut sample = sample.clone();
        let Some(extended) = &self.extended else { return sample };
        for (measured, output) in sample.measured.iter_mut().zip(outputs) {
            let [elevator, throttle] = extended.direct[*output];
            let added = elevator * sample.input[0] + throttle * sample.input[1];
            *measured = measured.map(|measured| measured - added);
        }
        sample
    }
}

/// State and input of P1's steady flight.
fn climb() -> ([f64; 4], [f64; 2]) {
    let flight = SteadyFlight { airspeed: 40.0, climb_angle: 4.0_f64.to_radians() };
    let trim = Airframe::aerosonde().trim(&flight).expect("the Aerosonde flies");
    (trim.state.into(), trim.input.into())
}

/// The four states as outputs.
pub fn state_outputs() -> Vec<(String, [f64; 4])> {
    let unit = |state: usize| std::array::from_fn(|place| f64::from(u8::from(place == state)));
    STATE_COLUMNS
        .iter()
        .enumerate()
        .map(|(state, name)| ((*name).to_owned(), unit(state)))
        .collect()
}
