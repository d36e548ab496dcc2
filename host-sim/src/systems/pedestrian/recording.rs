//! A walk as it was recorded, with its truth where that is known: from files or synthetic.

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

/// A walk as it was recorded.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Recording {
    /// Where it was read.
    pub path: PathBuf,
    /// What the sensor said, corrected if that is known.
    pub log: Log,
    /// Where the foot stood; empty if nobody measured it.
    pub footprints: Vec<Footprint>,
    /// What the other foot's sensor said, if it had one.
    pub other_foot: Option<Box<Self>>,
    /// What the sensor measured wrong, and what it said before that was corrected; none if nobody knows.
    calibrated: Option<(Calibration<f64>, Vec<Sample>)>,
    /// The class of the sensor, once it was looked for.
    pub(super) class: OnceLock<SensorClass>,
}

/// Where a synthetic walk leads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Walked {
    /// Once along the paper's route.
    Route,
    /// So many rounds through the same flat.
    Rounds(u32),
}

impl Recording {
    /// Reads a log and, if they were measured, its footprints.
    ///
    /// # Errors
    /// As [`log::read`] and [`truth::read`].
    pub fn read(path: &Path, footprints: Option<&Path>, options: &Options) -> Result<Self, Error> {
        let log = log::read(path, options)?;
        let footprints = footprints.map(|path| truth::read(path, &log)).transpose()?;
        let footprints = footprints.unwrap_or_default();
        Ok(Self { path: path.to_path_buf(), log, footprints, ..Self::default() })
    }

    /// With what the sensor measured wrong corrected.
    #[must_use]
    pub fn calibrated(mut self, calibration: Calibration<f64>) -> Self {
        let correct = |sample: &Sample| calibration::corrected(&calibration, sample);
        let corrected = self.log.samples.iter().map(correct).collect();
        let measured = std::mem::replace(&mut self.log.samples, corrected);
        Self { calibrated: Some((calibration, measured)), class: OnceLock::new(), ..self }
    }

    /// What the sensor measured wrong, if that is known.
    pub fn calibration(&self) -> Option<&Calibration<f64>> {
        self.calibrated.as_ref().map(|(calibration, _)| calibration)
    }

    /// What the sensor said, as it said it: the ends of its range are where they were.
    pub fn measured(&self) -> &[Sample] {
        self.calibrated.as_ref().map_or(&self.log.samples, |(_, measured)| measured)
    }

    /// Walk number `index` of a seed, logged at `rate_hz`: that of the paper's route in the paper's text format,
    /// with the rounding that comes with it, others with every bit of the sensor.
    ///
    /// # Errors
    /// None that a sensor could cause; those of [`log::parse`].
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

    /// The rates to which it can be averaged down, Hz: least, most, and from one to the next.
    pub fn rates_hz(&self) -> [f64; 3] {
        let own = resample::rate_hz(&self.log.samples).unwrap_or(1.0);
        [1.0, own.round().max(1.0), 1.0]
    }

    /// Averaged down to this rate.
    ///
    /// # Errors
    /// As [`resample::average_down`].
    pub fn at_rate(&self, rate_hz: f64) -> Result<Self, Error> {
        let log = resample::average_down(&self.log, rate_hz)?;
        // A log that is slower stays as it is.
        let at_rate = |other: &Self| other.at_rate(rate_hz).unwrap_or_else(|_| other.clone());
        let other_foot = self.other_foot.as_deref().map(|other| Box::new(at_rate(other)));
        let footprints = self.footprints.clone();
        Ok(Self { log, path: self.path.clone(), footprints, other_foot, ..Self::default() })
    }

    /// Where the foot or the sensor truly was, as far as anybody knows: measured footprints replace what the
    /// log says.
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
    /// Draws such a walk.
    pub fn draw<R: rand_core::Rng + ?Sized>(self, rng: &mut R) -> Scenario {
        match self {
            Self::Route => Scenario::draw(rng),
            Self::Rounds(rounds) => Scenario::draw_rounds(rng, rounds),
        }
    }
}
