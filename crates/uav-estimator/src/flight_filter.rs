use kestirim_health::Health;
use kestirim_kalman::Innovation;
use kestirim_scalar::Scalar;
use nalgebra::{SMatrix, SVector};

use crate::transitions::Transitions;
use crate::watch::Watch;
use crate::{Dynamics, Error, KalmanFilter, Noise, Sample, Transition};

/// Standard deviations of states that are entirely unknown: rad, rad/s, m/s, rad.
pub(crate) const UNKNOWN: [f64; 4] = [0.2, 0.5, 20.0, 0.5];

/// A Kalman filter along a flight: samples at any times, with gaps and missing outputs.
///
/// Over a gap the model is predicted by the gap's length, and the uncertainty grows by the noise of the inputs in it.
/// The estimate includes the newest sample. It starts at zero deviation with standard deviations of 0.2 rad, 0.5
/// rad/s, 20 m/s and 0.5 rad, so that the first samples dominate.
///
/// An output whose innovation exceeds 5 σ is rejected, but at most five times in a row: after that the estimate must
/// be wrong, and all measurements are used until they agree with it again.
///
/// The steps of up to L intervals are cached, the last one for each remainder of the interval in µs modulo L: 336
/// bytes each in `f64`. With regular samples one is enough; other intervals are computed anew.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FlightFilter<T: Scalar, const P: usize, const L: usize = 1> {
    filter: KalmanFilter<T, P>,
    watch: Watch<P>,
    transitions: Transitions<Dynamics, Transition<T>, L>,
    /// Time (µs) and input of the previous sample.
    before: Option<(i64, SVector<f64, 2>)>,
}

impl<T: Scalar, const P: usize, const L: usize> FlightFilter<T, P, L> {
    /// Creates a filter of this model and outputs y = C x, for samples every `usual` seconds: the noise of the inputs
    /// is white at that rate.
    ///
    /// # Errors
    /// [`Error::NotFinite`] for C or the outputs' noise.
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

    /// Sets the usual interval, s.
    pub fn set_usual(&mut self, usual: f64) {
        self.transitions.set_usual(usual);
    }

    /// The filter, with the estimate and its uncertainty at the time of the last sample.
    pub const fn filter(&self) -> &KalmanFilter<T, P> {
        &self.filter
    }

    /// Number of rejections of each output, for contradicting the estimate.
    pub const fn rejected(&self) -> &[u32; P] {
        &self.watch.rejected
    }

    /// Whether the estimate is reliable: reports `innovations` if over about 200 samples the mean normalised
    /// innovation squared, each limited to 10, exceeds 2.25; `rejected` if over about 50 samples more than a tenth of
    /// the measurements were rejected; `time` if over about 1000 samples the innovations are correlated with the
    /// motion of the outputs, as happens if outputs or inputs are late by about four samples.
    pub fn health(&self) -> Health {
        self.watch.health()
    }

    /// Processes a sample, and returns the innovations of its outputs. The filter begins anew with a sample that is more
    /// than a second older than the previous one (the clock was set back), or more than a million usual intervals later;
    /// with a discrete-time model also with one that, after more than ten intervals, is no whole number of steps later.
    ///
    /// # Errors
    /// [`Error::OutOfOrder`], [`Error::WrongInterval`], [`Error::NotFinite`], [`Error::Design`] or
    /// [`Error::Estimate`]; the filter is unchanged.
    pub fn take(&mut self, sample: &Sample<P>) -> Result<[Option<Innovation<f64>>; P], Error> {
        if !sample.input.iter().copied().all(f64::is_finite) {
            return Err(Error::NotFinite);
        }
        let (mut next, mut watch) = (self.filter, self.watch);
        let mut moved = None;
        if let Some((before_us, input)) = &self.before {
            moved = self.transitions.between(*before_us, sample.time_us, Transition::new)?;
            if let Some((_, transition)) = &moved {
                next.predict(transition, input)?;
            } else {
                next = next.begun_anew(&SVector::from(UNKNOWN));
                watch.begin_anew();
            }
        }
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
