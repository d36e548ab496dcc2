use kestirim_health::Health;
use kestirim_kalman::Innovation;
use kestirim_scalar::Scalar;
use nalgebra::SVector;

use super::flight::{Flown, taken};
use super::local::Models;
use super::{AugmentedFilter, AugmentedStep, LocalModel, ScheduledFilter, ScheduledTransition};
use crate::transitions::Transitions;
use crate::watch::Watch;
use crate::{Error, Sample};

/// A [`ScheduledFilter`] along a flight: samples at any times, with gaps and missing outputs.
///
/// Gaps, gates, the clock and L are handled as in a [`FlightFilter`](crate::FlightFilter). A new interval is
/// discretised for each of the G models, but only once for a repeated one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ScheduledFlight<
    T: Scalar,
    const N: usize,
    const K: usize,
    const P: usize,
    const G: usize,
    const L: usize = 1,
> {
    filter: ScheduledFilter<T, N, K, P, G>,
    watch: Watch<P>,
    transitions: Transitions<Models<N, K, P, G>, ScheduledTransition<T, N, K, G>, L>,
    /// Time (µs) and input of the previous sample.
    before: Option<(i64, SVector<f64, 2>)>,
}

impl<T: Scalar, const N: usize, const K: usize, const P: usize, const G: usize, const L: usize>
    ScheduledFlight<T, N, K, P, G, L>
{
    /// Creates a filter of these models for samples every `usual` seconds; `inputs` are the standard deviations, per
    /// usual interval, of the white noise on the inputs δe (rad) and δt.
    ///
    /// # Errors
    /// Those of [`ScheduledFilter::new`]: [`Error::NotFinite`] or [`Error::Grid`].
    pub fn new(
        models: &[LocalModel<N, K, P>; G],
        inputs: &SVector<f64, 2>,
        usual: f64,
    ) -> Result<Self, Error> {
        let filter = ScheduledFilter::new(models)?;
        let models = Models { models: models.each_ref().map(|local| local.model) };
        let transitions = Transitions::new(models, usual, *inputs);
        Ok(Self { filter, watch: Watch::NEW, transitions, before: None })
    }

    /// Sets the usual interval, s.
    pub fn set_usual(&mut self, usual: f64) {
        self.transitions.set_usual(usual);
    }

    /// The filter, with the estimate and its uncertainty at the time of the last sample.
    pub const fn filter(&self) -> &AugmentedFilter<T, N, K, P> {
        self.filter.filter()
    }

    /// Number of rejections of each output, for contradicting the estimate.
    pub const fn rejected(&self) -> &[u32; P] {
        &self.watch.rejected
    }

    /// Whether the estimate is reliable: see [`FlightFilter::health`](crate::FlightFilter::health).
    pub fn health(&self) -> Health {
        self.watch.health()
    }

    /// Processes a sample, in deviations from the models' origin, and returns the innovations of its outputs. If it
    /// is more than a second older than the previous one, the clock was set back, and the filter restarts.
    ///
    /// # Errors
    /// [`Error::OutOfOrder`], [`Error::NotFinite`], [`Error::Design`] or [`Error::Estimate`]; the
    /// filter is unchanged.
    pub fn take(&mut self, sample: &Sample<P>) -> Result<[Option<Innovation<f64>>; P], Error> {
        taken(&mut self.filter, &mut self.watch, &mut self.transitions, &mut self.before, sample)
    }
}

impl<T: Scalar, const N: usize, const K: usize, const P: usize, const G: usize> Flown<T, N, K, P>
    for ScheduledFilter<T, N, K, P, G>
{
    type Step = [AugmentedStep<N>; G];
    type Transition = ScheduledTransition<T, N, K, G>;

    fn filter(&self) -> &AugmentedFilter<T, N, K, P> {
        Self::filter(self)
    }

    fn begun_anew(&self) -> Self {
        Self::begun_anew(self)
    }

    fn transition(&self, step: &Self::Step) -> Self::Transition {
        Self::transition(self, step)
    }

    fn predict(
        &mut self,
        transition: &Self::Transition,
        input: &SVector<T, 2>,
    ) -> Result<(), Error> {
        Self::predict(self, transition, input)
    }

    fn prepared(
        &mut self,
        measured: &mut [Option<T>; P],
    ) -> Result<&mut AugmentedFilter<T, N, K, P>, Error> {
        self.grid.prepare(&mut self.filter, measured)?;
        Ok(&mut self.filter)
    }
}
