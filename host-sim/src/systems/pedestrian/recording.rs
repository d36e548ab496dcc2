//! Recorded walks, with the truth where it is known, from files or synthetic.

pub mod calibration;
pub mod log;
pub mod resample;
pub mod truth;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use kestirim_import::{Format, Options};
use kestirim_imu_calibration::Calibration;
use kestirim_pedestrian::SensorClass;
use kestirim_replay::pedestrian::{Footprint, TrackPoint};

use self::log::Log;
use super::Sample;
use super::simulate::scenario::Scenario;
use super::simulate::sensor;
use crate::Error;
use crate::random::stream;

/// A recorded walk and its related data.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Recording {
    /// The path of the log.
    pub path: PathBuf,
    /// The log, corrected if there is a calibration.
    pub log: Log,
    /// The measured positions of the foot; empty if there are none.
    pub footprints: Vec<Footprint>,
    /// The recording of the other foot, if it had a sensor.
    pub other_foot: Option<Box<Self>>,
    /// The calibration of the sensor with the uncorrected samples; `None` if there is none.
    calibrated: Option<(Calibration<f64>, Vec<Sample>)>,
    /// The class of the sensor, once it has been determined.
    pub(super) class: OnceLock<SensorClass>,
}

/// The route of a synthetic walk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Walked {
    /// The paper's route, once.
    Route,
    /// This number of rounds through the same flat.
    Rounds(u32),
}

impl Recording {
    /// Reads a log and its measured footprints, if there are any.
    ///
    /// # Errors
    /// Those of [`log::read`] and [`truth::read`].
    pub fn read(path: &Path, footprints: Option<&Path>, options: &Options) -> Result<Self, Error> {
        let log = log::read(path, options)?;
        let footprints = footprints.map(|path| truth::read(path, &log)).transpose()?;
        let footprints = footprints.unwrap_or_default();
        Ok(Self { path: path.to_path_buf(), log, footprints, ..Self::default() })
    }

    /// Corrects the samples by a calibration.
    #[must_use]
    pub fn calibrated(mut self, calibration: Calibration<f64>) -> Self {
        let correct = |sample: &Sample| calibration::corrected(&calibration, sample);
        let corrected = self.log.samples.iter().map(correct).collect();
        let measured = std::mem::replace(&mut self.log.samples, corrected);
        Self { calibrated: Some((calibration, measured)), class: OnceLock::new(), ..self }
    }

    /// The calibration of the sensor, if there is one.
    pub fn calibration(&self) -> Option<&Calibration<f64>> {
        self.calibrated.as_ref().map(|(calibration, _)| calibration)
    }

    /// The uncorrected samples, in which the limits of the sensor's range are undistorted.
    pub fn measured(&self) -> &[Sample] {
        self.calibrated.as_ref().map_or(&self.log.samples, |(_, measured)| measured)
    }

    /// Generates the walk number `index` of a seed, logged at `rate_hz`: one on the paper's route in the paper's text
    /// format, including its rounding, others in full precision.
    ///
    /// # Errors
    /// Those of [`log::parse`], which no sensor can cause.
    pub fn synthetic(walked: Walked, rate_hz: f64, seed: u64, index: u64) -> Result<Self, Error> {
        let mut rng = stream(seed, index);
        let scenario = walked.draw(&mut rng);
        let measured = sensor::measure(&mut rng, &scenario.ideal_imu(rate_hz), rate_hz);
        let path = PathBuf::from("synthetic walk");
        let log = match walked {
            Walked::Route => {
                let text = sensor::razor_text(&measured).into_bytes();
                let options = Options { format: Some(Format::Razor), ..Options::default() };
                log::parse(&path, &text, &options)?
            }
            Walked::Rounds(_) => Log { samples: measured, ..Log::default() },
        };
        Ok(Self { path, log, footprints: scenario.footprints(), ..Self::default() })
    }

    /// The rates to which the log can be averaged down (Hz): minimum, maximum and step.
    pub fn rates_hz(&self) -> [f64; 3] {
        let own = resample::rate_hz(&self.log.samples).unwrap_or(1.0);
        [1.0, own.round().max(1.0), 1.0]
    }

    /// The recording averaged down to this rate.
    ///
    /// # Errors
    /// Those of [`resample::average_down`].
    pub fn at_rate(&self, rate_hz: f64) -> Result<Self, Error> {
        let log = resample::average_down(&self.log, rate_hz)?;
        // A slower log stays as it is.
        let at_rate = |other: &Self| other.at_rate(rate_hz).unwrap_or_else(|_| other.clone());
        let other_foot = self.other_foot.as_deref().map(|other| Box::new(at_rate(other)));
        let footprints = self.footprints.clone();
        Ok(Self { log, path: self.path.clone(), footprints, other_foot, ..Self::default() })
    }

    /// The true positions of the foot or the sensor, as far as they are known: measured footprints take precedence over
    /// the truth in the log.
    pub fn truth(&self) -> Vec<TrackPoint> {
        let flat = |footprint: &Footprint| {
            let [x, y] = footprint.position;
            TrackPoint { time_us: footprint.time_us, position: [x, y, f64::NAN] }
        };
        match &self.log.truth {
            Some(truth) if self.footprints.is_empty() => truth.clone(),
            _ => self.footprints.iter().map(flat).collect(),
        }
    }
}

impl Walked {
    /// Draws a walk on this route.
    pub fn draw<R: rand_core::Rng + ?Sized>(self, rng: &mut R) -> Scenario {
        match self {
            Self::Route => Scenario::draw(rng),
            Self::Rounds(rounds) => Scenario::draw_rounds(rng, rounds),
        }
    }
}
