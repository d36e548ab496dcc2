use kestirim_health::Health;
use kestirim_kalman::Innovation;
use kestirim_scalar::Scalar;
use nalgebra::{SMatrix, SVector};

use crate::transitions::{Transitions, interval_us, is_set_back};
use crate::watch::Watch;
use crate::{Dynamics, Error, KalmanFilter, Noise, Sample, Transition};

/// Standard deviations of a state of which nothing is known: rad, rad/s, m/s, rad.
pub(crate) const UNKNOWN: [f64; 4] = [0.2, 0.5, 20.0, 0.5];

/// A Kalman filter along a flight: samples of any times, with gaps between them and outputs that are missing.
///
/// Over a gap the model is moved on by the gap's length, and the uncertainty grows by the noise of the inputs in it.
/// The estimate has seen the newest sample. It begins at zero deviation with standard deviations of 0.2 rad,
/// 0.5 rad/s, 20 m/s and 0.5 rad, so that the first samples decide.
///
/// An output that is more than 5 σ from what was expected of it is left out, as long as that are not more than five in a
/// row: then it is the estimate that must be wrong, and all are taken in until they agree with it again.
///
/// The steps of up to L intervals are kept, the last one for each remainder of an interval's microseconds by L: 336
/// bytes each in `f64`. With regular samples one is enough; other intervals are computed anew.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FlightFilter<T: Scalar, const P: usize, const L: usize = 1> {
    filter: KalmanFilter<T, P>,
    watch: Watch<P>,
    transitions: Transitions<Dynamics, Transition<T>, L>,
    /// Time (µs) and input of the sample before.
    before: Option<(i64, SVector<f64, 2>)>,
}

impl<T: Scalar, const P: usize, const L: usize> FlightFilter<T, P, L> {
    /// A filter of this model and outputs y = C x, measured every `usual` seconds: the noise of the inputs is white
    /// at that rate.
    ///
    /// # Errors
    /// [`Error::NotFinite`] of C or the outputs' noise.
    pub fn new(
        dynamics: &Dynamics,
        c: &SMatrix<f64, P, 4>,
        noise: &Noise<P>,
        usual: f64,
    ) -> Result<Self, Error> {
        let filter =
            KalmanFilter::new(c, &noise.outputs, &SVector::zeros(), &SVector::from(UNKNOWN))?;
        let transitions = Transitions::new(*dynamics, usual, noise.inputs);
        Ok(Self { filter, watch: Watch::NEW, transitions, before: None })
    }

    /// Says how long an interval usually is, s.
    pub fn set_usual(&mut self, usual: f64) {
        self.transitions.set_usual(usual);
    }

    /// The filter, with the estimate and its uncertainty at the time of the last sample.
    pub const fn filter(&self) -> &KalmanFilter<T, P> {
        &self.filter
    }

    /// How many times each output was left out, because it contradicted the estimate.
    pub const fn rejected(&self) -> &[u32; P] {
        &self.watch.rejected
    }

    /// Whether the estimate can be relied upon: `innovations` if over about 200 samples the normalised innovations
    /// squared are more than 2.25 on average, each counted for no more than 10; `rejected` if over about 50 more
    /// than a tenth of the measurements were left out; `time` if over about 1000 the innovations follow the movement of
    /// the outputs, as they do if outputs come late or inputs do, by four samples or so.
    pub fn health(&self) -> Health {
        self.watch.health()
    }

    /// Takes in a sample, and answers with what each of its outputs said beyond what was expected of it. One that is
    /// more than a second older than the one before is not late: the clock was set back, and the filter begins anew.
    ///
    /// # Errors
    /// [`Error::OutOfOrder`], [`Error::Gap`], [`Error::WrongInterval`], [`Error::NotFinite`], [`Error::Design`] or
    /// [`Error::Estimate`]; the filter is as it was.
    pub fn take(&mut self, sample: &Sample<P>) -> Result<[Option<Innovation<f64>>; P], Error> {
        if !sample.input.iter().copied().all(f64::is_finite) {
            return Err(Error::NotFinite);
        }
        let mut next = self.filter;
        let mut moved = None;
        if self.before.is_some_and(|(before_us, _)| is_set_back(before_us, sample.time_us)) {
            next = next.begun_anew(&SVector::from(UNKNOWN));
        } else if let Some((before_us, input)) = &self.before {
            let interval_us = interval_us(*before_us, sample.time_us)?;
            let transition = self.transitions.over(interval_us, Transition::new)?;
            next.predict(&transition, input)?;
            moved = Some((interval_us, transition));
        }
        let mut watch = self.watch;
        let judged = next.correct_gated(&sample.measured, &mut watch.gates)?;
        watch.count(&sample.measured, &judged);
        self.filter = next;
        self.watch = watch;
        self.before = Some((sample.time_us, sample.input));
        if let Some((interval_us, transition)) = &moved {
            self.transitions.keep(*interval_us, transition);
        }
        Ok(judged.innovations)
    }
}
