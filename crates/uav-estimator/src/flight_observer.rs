use core::iter;

use kestirim_health::Health;
use kestirim_luenberger::{CurrentGains, CurrentObserver, Plant};
use kestirim_observer_design::{Complex, Discrete};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

use crate::innovation_gate::InnovationGate;
use crate::monitor::Monitor;
use crate::transitions::Transitions;
use crate::{Dynamics, Error, Sample, Step, current_gain, observer_gain};

/// A Luenberger observer along a flight: samples at a usual interval, with gaps and missing outputs.
///
/// Over a gap the model is predicted by the gap's length; a missing output is replaced by its prediction. The
/// estimate includes the newest sample (the current form). It starts with the states that the first sample measures
/// directly, and zero for the others. For its steady-state error see
/// [`error_covariance`](kestirim_observer_design::error_covariance).
///
/// An output whose innovation is eight times as large as usual is rejected, but at most five times in a row.
///
/// The steps of L intervals other than the usual one are cached: see [`FlightFilter`](crate::FlightFilter).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize, T::Accumulator: serde::Serialize",
        deserialize = "T: serde::Deserialize<'de>, T::Accumulator: serde::Deserialize<'de>"
    ))
)]
pub struct FlightObserver<T: Scalar, const P: usize, const L: usize = 1> {
    observer: CurrentObserver<T, 4, 2, P>,
    c: SMatrix<f64, P, 4>,
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    gates: [InnovationGate; P],
    /// Number of rejections of each output.
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    rejected: [u32; P],
    monitor: Monitor,
    usual_us: i64,
    transitions: Transitions<Dynamics, Discrete<4, 2>, L>,
    /// Time (µs) and input of the previous sample.
    before: Option<(i64, SVector<f64, 2>)>,
}

impl<T: Scalar, const P: usize, const L: usize> FlightObserver<T, P, L> {
    /// Creates an observer of this model and outputs y = C x, for samples every `usual` seconds, with these
    /// discrete-time poles ([`observer_gain`]).
    ///
    /// # Errors
    /// [`Error::Design`], [`Error::Singular`], [`Error::WrongInterval`], [`Error::Observer`].
    pub fn new(
        dynamics: &Dynamics,
        c: &SMatrix<f64, P, 4>,
        poles: &[Complex<f64>; 4],
        usual: f64,
    ) -> Result<Self, Error> {
        let usual_us = libm::round(usual * 1e6) as i64;
        let noise = SVector::zeros();
        let plant = transition(&dynamics.over(usual, usual, &noise)?);
        let transitions = Transitions::new(*dynamics, usual, noise);
        let gain = current_gain(&plant, &observer_gain(&plant, c, poles)?)?;
        let gains = CurrentGains::new(&Plant { a: plant.a, b: plant.b, c: *c }, &gain);
        let observer = CurrentObserver::new(&gains, &SVector::zeros())?;
        let gates = [InnovationGate::default(); P];
        let (rejected, monitor) = ([0; P], Monitor::default());
        Ok(Self { observer, c: *c, gates, rejected, monitor, usual_us, transitions, before: None })
    }

    /// The estimate x̂ at the time of the last sample: α (rad), q (rad/s), V (m/s), θ (rad).
    pub fn estimate(&self) -> SVector<f64, 4> {
        self.observer.estimate().map(T::to_f64)
    }

    /// Number of rejections of each output, for contradicting the estimate.
    pub const fn rejected(&self) -> &[u32; P] {
        &self.rejected
    }

    /// Whether the estimate is reliable: reports `rejected` if over about 50 samples more than a tenth of the
    /// measurements contradicted it. An observer has no variances: whether its innovations are too large, or its inputs
    /// late, only a [`FlightFilter`](crate::FlightFilter) run in parallel can tell.
    pub fn health(&self) -> Health {
        self.monitor.health()
    }

    /// Processes a sample, and returns the innovations of its outputs, in their units. It begins anew where a
    /// [`FlightFilter`](crate::FlightFilter::take) does.
    ///
    /// # Errors
    /// [`Error::OutOfOrder`], [`Error::WrongInterval`], [`Error::NotFinite`], [`Error::Design`] or
    /// [`Error::Observer`]; the observer is unchanged.
    pub fn take(&mut self, sample: &Sample<P>) -> Result<[Option<f64>; P], Error> {
        let numbers = sample.input.iter().chain(sample.measured.iter().flatten());
        if !numbers.copied().all(f64::is_finite) {
            return Err(Error::NotFinite);
        }
        let (mut next, mut gates) = (self.observer, self.gates);
        let mut bridged = None;
        let is_usual = self.before.is_some_and(|(before_us, _)| {
            sample.time_us.checked_sub(before_us) == Some(self.usual_us)
        });
        if let Some((before_us, input)) = &self.before {
            if is_usual {
                next.predict(&input.map(T::from_f64))?;
            } else {
                bridged = self.transitions.between(*before_us, sample.time_us, transition)?;
            }
            if let Some((_, step)) = &bridged {
                let there = step.a * next.estimate().map(T::to_f64) + step.b * input;
                next.reset(&finite(&there)?)?;
            }
        }
        if !is_usual && bridged.is_none() {
            next.reset(&finite(&self.measured_states(&sample.measured))?)?;
            gates = [InnovationGate::default(); P];
        }
        let expected = (self.c * next.estimate().map(T::to_f64)).into();
        let (innovations, admitted) = judged(&mut gates, &sample.measured, &expected);
        next.correct(&SVector::from(admitted).map(T::from_f64))?;
        self.observer = next;
        self.gates = gates;
        self.before = Some((sample.time_us, sample.input));
        if let Some((interval_us, step)) = &bridged {
            self.transitions.keep(*interval_us, step);
        }
        let mut contradicting = 0;
        let outputs = sample.measured.iter().zip(&admitted).zip(&gates);
        for (rejected, ((measured, admitted), gate)) in self.rejected.iter_mut().zip(outputs) {
            let is_rejected = measured.is_some_and(|measured| measured != *admitted);
            *rejected = rejected.saturating_add(u32::from(is_rejected));
            // What an open gate admits contradicts no less.
            contradicting += usize::from(is_rejected || measured.is_some() && gate.is_open());
        }
        self.monitor.count(sample.measured.iter().flatten().count(), contradicting, iter::empty());
        Ok(innovations)
    }

    /// The states that an output measures directly, and zero for the others.
    fn measured_states(&self, measured: &[Option<f64>; P]) -> SVector<f64, 4> {
        let mut states = SVector::<f64, 4>::zeros();
        for output in 0..P {
            let row = self.c.as_columns().map(|column| column[output]);
            let single = row.iter().filter(|part| **part != 0.0).count() == 1;
            let Some(measured) = measured[output].filter(|_| single) else { continue };
            for (state, part) in states.as_array_mut().iter_mut().zip(row) {
                if part != 0.0 {
                    *state = measured / part;
                }
            }
        }
        states
    }
}

/// The innovations of the measured outputs, and all outputs as passed to the observer: those missing or contradicting
/// the estimate are replaced by their predictions.
fn judged<const P: usize>(
    gates: &mut [InnovationGate; P],
    measured: &[Option<f64>; P],
    expected: &[f64; P],
) -> ([Option<f64>; P], [f64; P]) {
    let (mut innovations, mut admitted) = ([None; P], *expected);
    let outputs = innovations.iter_mut().zip(&mut admitted);
    for ((gate, measured), (innovation, admitted)) in gates.iter_mut().zip(measured).zip(outputs) {
        let Some(measured) = *measured else { continue };
        let beyond = measured - *admitted;
        *innovation = Some(beyond);
        if gate.admits(beyond) {
            *admitted = measured;
        }
    }
    (innovations, admitted)
}

/// Converts a state to the scalar, if it is finite.
fn finite<T: Scalar>(state: &SVector<f64, 4>) -> Result<SVector<T, 4>, Error> {
    if state.iter().copied().all(f64::is_finite) {
        Ok(state.map(T::from_f64))
    } else {
        Err(Error::NotFinite)
    }
}

fn transition(step: &Step) -> Discrete<4, 2> {
    step.transition
}
