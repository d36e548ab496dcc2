//! Filters with room for everything a model can describe.

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

/// The number of states of the filter; `MOVING` is the number of those that move the four states of flight.
const STATES: usize = 16;
pub(super) const MOVING: usize = 10;
/// The largest number of outputs of a model that describes more than A, B and C.
pub const MOST_EXTENDED_OUTPUTS: usize = 8;
/// The largest number of models in a grid.
pub(super) const MOST_MODELS: usize = 8;
/// The number of different intervals of a log for which one model keeps its discretised steps.
const KEPT: usize = 32;
/// The number of different intervals of a log for which each model of a grid keeps its discretised steps.
const KEPT_OF_GRID: usize = 8;

/// The index of the airspeed V among the states.
pub(super) const AIRSPEED: usize = 2;

type Built = AugmentedModel<STATES, MOVING, MOST_EXTENDED_OUTPUTS>;
type Local = LocalModel<STATES, MOVING, MOST_EXTENDED_OUTPUTS>;
type One<T> = AugmentedFlight<T, STATES, MOVING, MOST_EXTENDED_OUTPUTS, KEPT>;
type Grid<T> = ScheduledFlight<T, STATES, MOVING, MOST_EXTENDED_OUTPUTS, MOST_MODELS, KEPT_OF_GRID>;

/// A filter with room for everything a model can describe.
#[derive(Debug, Clone)]
pub(super) enum Augmented<T: Scalar> {
    /// A filter with one model.
    One(Box<One<T>>),
    /// A filter with a grid of models.
    Grid(Box<Grid<T>>),
}

impl<T: Scalar> Augmented<T> {
    /// A filter for the given outputs of a model, measured every `usual` seconds, with gusts `gust` times as strong as
    /// the model states.
    ///
    /// # Errors
    /// [`uav::Error::NoRoom`] for a discrete-time model, or one that describes no more than A, B and C; and whatever
    /// else keeps the filter from being built.
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
        // The last model fills the unused places.
        let all = std::array::from_fn(|place| *locals.get(place).unwrap_or(last));
        Ok(Self::Grid(Box::new(ScheduledFlight::new(&all, &inputs, usual)?)))
    }

    /// Sets the usual length of an interval, s.
    pub(super) fn set_usual(&mut self, usual: f64) {
        match self {
            Self::One(flight) => flight.set_usual(usual),
            Self::Grid(flight) => flight.set_usual(usual),
        }
    }

    /// Processes a sample: [`AugmentedFlight::take`], [`ScheduledFlight::take`].
    ///
    /// # Errors
    /// Those of [`AugmentedFlight::take`] and [`ScheduledFlight::take`].
    pub(super) fn take(
        &mut self,
        sample: &Sample<MOST_EXTENDED_OUTPUTS>,
    ) -> Result<[Option<Innovation<f64>>; MOST_EXTENDED_OUTPUTS], uav::Error> {
        match self {
            Self::One(flight) => flight.take(sample),
            Self::Grid(flight) => flight.take(sample),
        }
    }

    /// The filter, which holds the estimate and its uncertainty at the time of the last sample.
    pub(super) fn filter(&self) -> &AugmentedFilter<T, STATES, MOVING, MOST_EXTENDED_OUTPUTS> {
        match self {
            Self::One(flight) => flight.filter(),
            Self::Grid(flight) => flight.filter(),
        }
    }

    /// The number of times each output was rejected because it contradicted the estimate.
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

/// The augmented model of a filter.
fn built(model: &Model, parts: &Parts) -> Result<Built, uav::Error> {
    let Dynamics::Continuous(plant) = &model.dynamics else { return Err(uav::Error::NoRoom) };
    // The remaining outputs are never measured: they are set to the airspeed, so that fixed point holds their variance.
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

/// A model of a grid, relative to the model whose steady flight is the origin.
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
