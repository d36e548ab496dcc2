use crate::clock::Tick;
use crate::detector::{Adaptive, StanceDetector};
use crate::engine::Engine;
use crate::navigator::{Ekf, Lite, Navigator};
use crate::{Alignment, Error, ImuSample, SensorClass, Stride, Warnings};
use kestirim_attitude::Orientation;
use kestirim_scalar::Scalar;
use nalgebra::SVector;

/// The settings of sensor and foot.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Config<T> {
    /// The class of the IMU.
    pub sensor: SensorClass,
    /// The height of the sensor above the ball of the foot, about which the foot rolls in stance (m). Zero treats the
    /// foot as motionless.
    pub contact_height: T,
    /// Whether a foot whose tilt was lost is levelled at the next calm stance. A detector with a threshold of its own
    /// judges a moving foot as standing so often that this may do harm.
    pub levels: bool,
}

impl<T: Scalar> Default for Config<T> {
    /// A consumer IMU on the instep, 7 cm up.
    fn default() -> Self {
        Self { sensor: SensorClass::default(), contact_height: T::from_f64(0.07), levels: true }
    }
}

/// The estimate of the foot's state after a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Estimate<T: Scalar> {
    /// The time of the sample (µs, the samples' clock).
    pub time_us: u64,
    /// The position of the sensor (m, earth: z up, from the start).
    pub position: SVector<T, 3>,
    /// The velocity of the sensor (m/s, earth).
    pub velocity: SVector<T, 3>,
    /// The orientation of the sensor, body → earth.
    pub orientation: Orientation<T>,
    /// Whether the foot stands.
    pub stance: bool,
    /// The stride that this sample completed, if any.
    pub stride: Option<Stride<T>>,
}

/// Tracks a foot, strictly causally: an estimate depends on the samples up to its own and on no later one.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize, N: serde::Serialize, D: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>, N: serde::Deserialize<'de>, D: serde::Deserialize<'de>"
    ))
)]
pub struct Tracker<T: Scalar, N, D = Adaptive<T>> {
    engine: Engine<T, N>,
    detector: D,
}

/// A [`Tracker`] in the paper's architecture: no covariance, half the cost.
pub type LiteTracker<T> = Tracker<T, Lite<T>>;
/// A [`Tracker`] with an error-state Kalman filter.
pub type EkfTracker<T> = Tracker<T, Ekf<T>>;

impl<T: Scalar, N: Navigator<T>> Tracker<T, N> {
    /// Creates a tracker with the adaptive detector.
    pub fn new(config: Config<T>) -> Self {
        Self::with_detector(config, Adaptive::default())
    }
}

impl<T: Scalar, N: Navigator<T>, D: StanceDetector<T>> Tracker<T, N, D> {
    /// Creates a tracker with a given detector.
    pub fn with_detector(config: Config<T>, detector: D) -> Self {
        Self { engine: Engine::new(config), detector }
    }

    /// Processes the next sample.
    ///
    /// A sample with the time of the last one is a row written twice and changes nothing; neither does one with exactly
    /// the rates of the last one while the foot turns, for 0.15 s: its sensor was not read again.
    ///
    /// # Errors
    /// [`Error`] if the sample cannot have been measured or is out of order; the tracker is unchanged.
    #[inline]
    pub fn update(&mut self, sample: &ImuSample<T>) -> Result<Estimate<T>, Error> {
        let examined = self.engine.examine(sample)?;
        let mut stride = None;
        if examined.0 != Tick::Duplicate {
            let motion = self.engine.motion(sample);
            let verdict = self.detector.update(&motion);
            stride = self.engine.advance(sample, examined, &motion, verdict);
        }
        Ok(self.engine.estimate(sample.time_us, stride))
    }

    /// Ends the walk: the stride that led to the stance the foot is in, if any.
    pub fn finish(&mut self) -> Option<Stride<T>> {
        self.engine.finish()
    }

    /// The length of the horizontal path walked, from stance to stance (m).
    pub fn path_length(&self) -> T {
        self.engine.path_length()
    }

    /// Suspicious findings about the stream so far.
    pub fn warnings(&self) -> Warnings {
        self.engine.warnings()
    }

    /// The biases learnt from standstills.
    pub fn alignment(&self) -> &Alignment<T> {
        &self.engine.alignment
    }
}
