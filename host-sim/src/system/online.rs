//! Estimators that follow a live stream.

use std::fmt::Debug;

use kestirim_health::Health;
use kestirim_telemetry::Message;

use crate::Error;
use crate::figure::Series;

/// All that is needed to build an estimator, and to rebuild it when the sender restarts.
pub trait Plan: Debug + Send + Sync {
    /// Builds a fresh estimator.
    ///
    /// # Errors
    /// An error if the settings or files are unsuitable.
    fn build(&self) -> Result<Box<dyn Online>, Error>;

    /// The series drawn on the map before any measurement has arrived.
    fn map(&self) -> Vec<Series> {
        Vec::new()
    }

    /// Assumptions made because nothing else was specified.
    fn assumptions(&self) -> Vec<String> {
        Vec::new()
    }
}

/// An estimator that follows a stream.
pub trait Online: Debug {
    /// Processes a measurement.
    fn take(&mut self, message: &Message) -> Outcome;

    /// Processes bytes of a device's own stream, for a system that [decodes them itself](super::System::HEARS_BYTES).
    fn hear(&mut self, _bytes: &[u8]) {}

    /// The number of epochs or messages decoded from the bytes, and how many of them were used.
    fn heard(&self) -> [u32; 2] {
        [0; 2]
    }

    /// Performs lengthy work while no more input is waiting.
    fn settle(&mut self) {}

    /// Ends the stream.
    ///
    /// # Errors
    /// An error if output that is due at the end cannot be written.
    fn finish(&mut self) -> Result<(), Error> {
        Ok(())
    }

    /// The current position (m): with z up, or for a satellite receiver in ECEF.
    fn position(&self) -> Option<[f64; 3]> {
        None
    }

    /// The current position on the map (m).
    fn place(&self) -> Option<[f64; 2]> {
        self.position().map(|[x, y, _]| [x, y])
    }

    /// The standard deviation of a horizontal component of the position (m), if the estimator knows it.
    fn sigma_m(&self) -> Option<f64> {
        None
    }

    /// The current angle of attack, pitch rate, airspeed and pitch angle: rad, rad/s, m/s, rad.
    fn state(&self) -> Option<[f64; 4]> {
        None
    }

    /// Whether the sensor is stationary.
    fn is_still(&self) -> bool {
        false
    }

    /// The horizontal length of the path, m.
    fn path_length_m(&self) -> Option<f64> {
        None
    }

    /// The doubts about the estimate; `None` while there is none, if the estimator does not judge itself, or if it is one of the
    /// [`facts`](Self::facts).
    fn health(&self) -> Option<Health> {
        None
    }

    /// Results by name, with their units.
    fn facts(&self) -> Vec<(String, String)> {
        Vec::new()
    }

    /// Warnings about the stream.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    /// The complete state of the estimator, for resuming elsewhere bit for bit.
    ///
    /// # Errors
    /// The reason why the state cannot be stored.
    fn snapshot(&self) -> Result<Vec<u8>, String> {
        Err("its estimator cannot be stored".to_owned())
    }

    /// Resumes from a stored state; returns `None` and changes nothing if the bytes are not a snapshot of such an
    /// estimator.
    fn restore(&mut self, _snapshot: &[u8]) -> Option<()> {
        None
    }
}

/// The effect of a message on an estimator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The message is not for this estimator.
    NotMine,
    /// The message was used.
    Taken,
    /// The message was rejected as implausible or too late.
    Refused,
}

impl Outcome {
    /// Taken if `taken`, refused otherwise.
    pub const fn taken(taken: bool) -> Self {
        if taken { Self::Taken } else { Self::Refused }
    }
}

/// A figure of a stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Panel {
    /// A map of positions.
    Map,
    /// The specific forces.
    Forces,
    /// The angular rates.
    Rates,
    /// The ranges to anchors.
    Ranges,
    /// The path losses.
    Losses,
    /// The angles and rates of an aircraft.
    Angles,
    /// The airspeed of an aircraft.
    Airspeed,
}

impl Panel {
    /// All panels, which are shown if the system that sends is not specified.
    pub const ALL: [Self; 7] = [
        Self::Map,
        Self::Forces,
        Self::Rates,
        Self::Ranges,
        Self::Losses,
        Self::Angles,
        Self::Airspeed,
    ];
}
