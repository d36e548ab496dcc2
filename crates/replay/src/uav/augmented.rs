//! Filters with room for all that a model may say.

use kestirim_health::Health;
use kestirim_kalman::Innovation;
use kestirim_scalar::Scalar;
use kestirim_uav_estimator::{
    self as uav, AugmentedFilter, AugmentedFlight, AugmentedModel, Dynamics, LocalModel, Output,
    Sample, ScheduledFlight,
};
use nalgebra::SVector;

use super::extended::{Parts, Unknown};
use super::{Model, Options};

/// States of the filter, those of them that move the four, and outputs.
const STATES: usize = 16;
pub(super) const MOVING: usize = 10;
/// Outputs that a model may have, if it says more than A, B and C.
pub const MOST_EXTENDED_OUTPUTS: usize = 8;
/// Models that a grid may have.
pub(super) const MOST_MODELS: usize = 8;
/// Intervals of a log of which the steps are kept, of one model …
const KEPT: usize = 32;
/// … and of a grid, where each is as many.
const KEPT_OF_GRID: usize = 8;

/// V among the states.
pub(super) const AIRSPEED: usize = 2;

type Built = AugmentedModel<STATES, MOVING, MOST_EXTENDED_OUTPUTS>;
type Local = LocalModel<STATES, MOVING, MOST_EXTENDED_OUTPUTS>;
type One<T> = AugmentedFlight<T, STATES, MOVING, MOST_EXTENDED_OUTPUTS, KEPT>;
type Grid<T> = ScheduledFlight<T, STATES, MOVING, MOST_EXTENDED_OUTPUTS, MOST_MODELS, KEPT_OF_GRID>;

/// A filter with room for all that a model may say.
#[derive(Debug, Clone)]
pub(super) enum Augmented<T: Scalar> {
    /// By one model.
    One(Box<One<T>>),
    /// By a grid of them.
    Grid(Box<Grid<T>>),
}

impl<T: Scalar> Augmented<T> {
    /// A filter of these outputs of a model, measured every `usual` seconds, with gusts of so many times what the model says.
    ///
    /// # Errors
    /// [`uav::Error::NoRoom`] for a model of discrete time, or one that says no more than A, B and C; and whatever else keeps
    /// the filter from being built.
    pub(super) fn new(
        model: &Model,
        outputs: &[usize],
        options: &Options,
        gust: f64,
        usual: f64,
    ) -> Result<Self, uav::Error> {
        let parts = |model| Parts::of(model, outputs, options, gust).ok_or(uav::Error::NoRoom);
        let of = parts(model)?;
        let inputs = SVector::from(of.inputs);
        let grid = model.extended.as_ref().map_or(&[][..], |extended| &extended.grid);
        let locals = grid.iter().map(|it| local(it, &parts(it)?, model, outputs));
        let locals = locals.collect::<Result<Vec<_>, _>>()?;
        let Some(last) = locals.last() else {
            let flight = AugmentedFlight::new(&built(model, &of)?, &inputs, usual)?;
            return Ok(Self::One(Box::new(flight)));
        };
        if locals.len() > MOST_MODELS {
            return Err(uav::Error::NoRoom);
        }
        // The last one fills what is left.
        let all = std::array::from_fn(|place| *locals.get(place).unwrap_or(last));
        Ok(Self::Grid(Box::new(ScheduledFlight::new(&all, &inputs, usual)?)))
    }

    /// Says how long an interval usually is, s.
    pub(super) fn set_usual(&mut self, usual: f64) {
        match self {
            Self::One(flight) => flight.set_usual(usual),
            Self::Grid(flight) => flight.set_usual(usual),
        }
    }

    /// Takes in a sample: [`AugmentedFlight::take`], [`ScheduledFlight::take`].
    ///
    /// # Errors
    /// As these.
    pub(super) fn take(
        &mut self,
        sample: &Sample<MOST_EXTENDED_OUTPUTS>,
    ) -> Result<[Option<Innovation<f64>>; MOST_EXTENDED_OUTPUTS], uav::Error> {
        match self {
            Self::One(flight) => flight.take(sample),
            Self::Grid(flight) => flight.take(sample),
        }
    }

    /// The filter, with the estimate and its uncertainty at the time of the last sample.
    pub(super) fn filter(&self) -> &AugmentedFilter<T, STATES, MOVING, MOST_EXTENDED_OUTPUTS> {
        match self {
            Self::One(flight) => flight.filter(),
            Self::Grid(flight) => flight.filter(),
        }
    }

    /// How many times each output was left out, because it contradicted the estimate.
    pub(super) fn rejected(&self) -> &[u32; MOST_EXTENDED_OUTPUTS] {
        match self {
            Self::One(flight) => flight.rejected(),
            Self::Grid(flight) => flight.rejected(),
        }
    }

    /// Whether the estimate can be relied upon.
    pub(super) fn health(&self) -> Health {
        match self {
            Self::One(flight) => flight.health(),
            Self::Grid(flight) => flight.health(),
        }
    }
}

/// The model of a filter.
fn built(model: &Model, parts: &Parts) -> Result<Built, uav::Error> {
    let Dynamics::Continuous(plant) = &model.dynamics else { return Err(uav::Error::NoRoom) };
    // Outputs that are never measured fill the rest: of the airspeed, so that fixed point holds their variance.
    let mut outputs = [Output::state(AIRSPEED, 1.0); MOST_EXTENDED_OUTPUTS];
    for (place, output) in outputs.iter_mut().zip(&parts.outputs) {
        *place = *output;
    }
    let mut built = Built::new(plant, &parts.process, &outputs)?;
    for unknown in &parts.unknown {
        built = match unknown {
            Unknown::Gust(gust) => built.with_gust(gust),
            Unknown::Force(state, drift) => built.with_force(*state, drift),
            Unknown::Bias(output, drift) => built.with_bias(*output, drift),
            Unknown::Wind(drift) => built.with_wind(drift),
            Unknown::Density(drift) => built.with_density(drift),
        }?;
    }
    Ok(built)
}

/// A model of a grid, beside the one whose steady flight is the origin.
fn local(
    model: &Model,
    parts: &Parts,
    origin: &Model,
    outputs: &[usize],
) -> Result<Local, uav::Error> {
    let (state, input) = model.trim.ok_or(uav::Error::Grid)?;
    let (from, held) = origin.trim.ok_or(uav::Error::Grid)?;
    let shown =
        |output: usize| model.shown(output, true, &state) - origin.shown(output, true, &from);
    let shown = |place: usize| outputs.get(place).map_or(0.0, |&output| shown(output));
    Ok(LocalModel {
        model: built(model, parts)?,
        state: SVector::from(state) - SVector::from(from),
        input: SVector::from(input) - SVector::from(held),
        outputs: SVector::from_fn(|place, _| shown(place)),
    })
}
