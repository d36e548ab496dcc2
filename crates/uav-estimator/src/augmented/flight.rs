use kestirim_health::Health;
use kestirim_kalman::Innovation;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

use super::{AugmentedFilter, AugmentedModel, AugmentedStep, AugmentedTransition};
use crate::kalman_filter::{GATE, Gated};
use crate::transitions::{Moves, Transitions};
use crate::watch::Watch;
use crate::{Error, Sample};

/// An [`AugmentedFilter`] along a flight: samples at any times, with gaps and missing outputs.
///
/// Gaps, gates, the clock and L are handled as in a [`FlightFilter`](crate::FlightFilter).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AugmentedFlight<
    T: Scalar,
    const N: usize,
    const K: usize,
    const P: usize,
    const L: usize = 1,
> {
    filter: AugmentedFilter<T, N, K, P>,
    watch: Watch<P>,
    transitions: Transitions<AugmentedModel<N, K, P>, AugmentedTransition<T, N, K>, L>,
    /// Time (µs) and input of the previous sample.
    before: Option<(i64, SVector<f64, 2>)>,
}

impl<T: Scalar, const N: usize, const K: usize, const P: usize, const L: usize>
    AugmentedFlight<T, N, K, P, L>
{
    /// Creates a filter of this model for samples every `usual` seconds; `inputs` are the standard deviations, per
    /// usual interval, of the white noise on the inputs δe (rad) and δt.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn new(
        model: &AugmentedModel<N, K, P>,
        inputs: &SVector<f64, 2>,
        usual: f64,
    ) -> Result<Self, Error> {
        let filter = AugmentedFilter::new(model)?;
        let transitions = Transitions::new(*model, usual, *inputs);
        Ok(Self { filter, watch: Watch::NEW, transitions, before: None })
    }

    /// Sets the usual interval, s.
    pub fn set_usual(&mut self, usual: f64) {
        self.transitions.set_usual(usual);
    }

    /// The filter, with the estimate and its uncertainty at the time of the last sample.
    pub const fn filter(&self) -> &AugmentedFilter<T, N, K, P> {
        &self.filter
    }

    /// Number of rejections of each output, for contradicting the estimate.
    pub const fn rejected(&self) -> &[u32; P] {
        &self.watch.rejected
    }

    /// Whether the estimate is reliable: see [`FlightFilter::health`](crate::FlightFilter::health).
    pub fn health(&self) -> Health {
        self.watch.health()
    }

    /// Processes a sample, and returns the innovations of its outputs. If it is more than a second older than the
    /// previous one, the clock was set back, and the filter restarts.
    ///
    /// # Errors
    /// [`Error::OutOfOrder`], [`Error::NotFinite`], [`Error::Design`] or [`Error::Estimate`]; the
    /// filter is unchanged.
    pub fn take(&mut self, sample: &Sample<P>) -> Result<[Option<Innovation<f64>>; P], Error> {
        taken(&mut self.filter, &mut self.watch, &mut self.transitions, &mut self.before, sample)
    }
}

/// A filter that can be run along a flight.
pub(super) trait Flown<T: Scalar, const N: usize, const K: usize, const P: usize>:
    Copy
{
    /// The model's step over an interval.
    type Step;
    /// The step in the filter's scalar and units.
    type Transition: Copy;

    /// The underlying filter, with its estimate and units.
    fn filter(&self) -> &AugmentedFilter<T, N, K, P>;

    /// A copy of the filter, reset to its initial state.
    fn begun_anew(&self) -> Self;

    /// Converts a step.
    fn transition(&self, step: &Self::Step) -> Self::Transition;

    /// Predicts over a step.
    fn predict(
        &mut self,
        transition: &Self::Transition,
        input: &SVector<T, 2>,
    ) -> Result<(), Error>;

    /// The filter that processes these outputs, after subtracting the parts that it does not model.
    fn prepared(
        &mut self,
        measured: &mut [Option<T>; P],
    ) -> Result<&mut AugmentedFilter<T, N, K, P>, Error>;
}

impl<T: Scalar, const N: usize, const K: usize, const P: usize> Flown<T, N, K, P>
    for AugmentedFilter<T, N, K, P>
{
    type Step = AugmentedStep<N>;
    type Transition = AugmentedTransition<T, N, K>;

    fn filter(&self) -> &Self {
        self
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

    fn prepared(&mut self, _measured: &mut [Option<T>; P]) -> Result<&mut Self, Error> {
        Ok(self)
    }
}

/// Processes a sample of a flight; after an error nothing is changed.
pub(super) fn taken<T, F, D, const N: usize, const K: usize, const P: usize, const L: usize>(
    filter: &mut F,
    watch: &mut Watch<P>,
    transitions: &mut Transitions<D, F::Transition, L>,
    before: &mut Option<(i64, SVector<f64, 2>)>,
    sample: &Sample<P>,
) -> Result<[Option<Innovation<f64>>; P], Error>
where
    T: Scalar,
    F: Flown<T, N, K, P>,
    D: Moves<Step = F::Step>,
{
    let numbers = sample.input.iter().chain(sample.measured.iter().flatten());
    if !numbers.copied().all(f64::is_finite) {
        return Err(Error::NotFinite);
    }
    let (mut next, mut watched) = (*filter, *watch);
    let mut moved = None;
    if let Some((before_us, input)) = before {
        let form = |step: &D::Step| next.transition(step);
        moved = transitions.between(*before_us, sample.time_us, form)?;
        if let Some((_, transition)) = &moved {
            next.predict(transition, &input.map(T::from_f64))?;
        } else {
            next = next.begun_anew();
            watched.begin_anew();
        }
    }
    let judged = judged(&mut next, sample, &mut watched)?;
    // For outputs with direct dependence on the inputs, a slightly wrong gain looks like lateness.
    let mut timed = sample.measured;
    for (output, measured) in timed.iter_mut().enumerate() {
        *measured = measured.filter(|_| !next.filter().is_direct(output));
    }
    watched.count(&timed, &judged);
    *filter = next;
    *watch = watched;
    *before = Some((sample.time_us, sample.input));
    if let Some((interval_us, transition)) = &moved {
        transitions.keep(*interval_us, transition);
    }
    Ok(judged.innovations)
}

/// Processes the measurements that the gates admit.
fn judged<T, F, const N: usize, const K: usize, const P: usize>(
    filter: &mut F,
    sample: &Sample<P>,
    watch: &mut Watch<P>,
) -> Result<Gated<P>, Error>
where
    T: Scalar,
    F: Flown<T, N, K, P>,
{
    let units = *filter.filter().output_units().as_array();
    let mut measured = [None; P];
    for (scaled, (value, unit)) in measured.iter_mut().zip(sample.measured.iter().zip(units)) {
        *scaled = value.map(|value| T::from_f64(value / unit));
    }
    let mut is_left_out = [false; P];
    let input = sample.input.map(T::from_f64);
    let gates = &mut watch.gates;
    let filter = filter.prepared(&mut measured)?;
    let reported = filter.correct_with(&measured, &input, |next, weighed, output| {
        // No index is used: it would require a bounds check.
        if let Some((gate, is_left_out)) = gates.get_mut(output).zip(is_left_out.get_mut(output)) {
            *is_left_out = !gate.admits(weighed.exceeds(T::from_f64(GATE)));
            if *is_left_out {
                return Ok(weighed.report());
            }
        }
        Ok(next.correct(weighed)?)
    })?;
    let mut innovations = [None; P];
    for (innovation, (reported, unit)) in innovations.iter_mut().zip(reported.iter().zip(units)) {
        *innovation = reported.as_ref().map(|reported| Innovation {
            innovation: reported.innovation.to_f64() * unit,
            variance: reported.variance.to_f64() * (unit * unit),
            nis: reported.nis.to_f64(),
        });
    }
    Ok(Gated { innovations, is_left_out })
}
