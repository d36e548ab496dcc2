//! An estimator that follows a stream while it comes.

use std::fmt::Debug;

use kestirim_telemetry::Message;

use crate::Error;
use crate::figure::Series;

/// All that an estimator is built from, to build it again when the sender begins anew.
pub trait Plan: Debug + Send + Sync {
    /// A fresh estimator.
    ///
    /// # Errors
    /// If the settings or files will not do.
    fn build(&self) -> Result<Box<dyn Online>, Error>;

    /// What is drawn on the map before anything is known.
    fn map(&self) -> Vec<Series> {
        Vec::new()
    }

    /// What was assumed because nobody said otherwise.
    fn assumptions(&self) -> Vec<String> {
        Vec::new()
    }
}

/// An estimator that follows a stream.
pub trait Online: Debug {
    /// Takes in a measurement.
    fn take(&mut self, message: &Message) -> Outcome;

    /// Takes in bytes of a device's own stream, of a system that [hears them](super::System::HEARS_BYTES).
    fn hear(&mut self, _bytes: &[u8]) {}

    /// How many epochs or messages it made of all bytes, and how many of them it took in.
    fn heard(&self) -> [u32; 2] {
        [0; 2]
    }

    /// Nothing more is there for now: time for what takes long.
    fn settle(&mut self) {}

    /// The stream has ended.
    ///
    /// # Errors
    /// If something that was to be written at its end cannot be.
    fn finish(&mut self) -> Result<(), Error> {
        Ok(())
    }

    /// The position now, m: z up, or of a receiver of satellites ECEF.
    fn position(&self) -> Option<[f64; 3]> {
        None
    }

    /// Where that is on the map, m.
    fn place(&self) -> Option<[f64; 2]> {
        self.position().map(|[x, y, _]| [x, y])
    }

    /// Standard deviation of a horizontal component of the position (m), of an estimator that knows it.
    fn sigma_m(&self) -> Option<f64> {
        None
    }

    /// Angle of attack, pitch rate, airspeed and pitch now: rad, rad/s, m/s, rad.
    fn state(&self) -> Option<[f64; 4]> {
        None
    }

    /// Whether the sensor stands still.
    fn is_still(&self) -> bool {
        false
    }

    /// The horizontal length of the path, m.
    fn path_length_m(&self) -> Option<f64> {
        None
    }

    /// Numbers with their units, by name.
    fn facts(&self) -> Vec<(String, String)> {
        Vec::new()
    }

    /// What is suspicious about the stream.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    /// All that it needs to go on elsewhere, to the bit.
    ///
    /// # Errors
    /// Why it cannot be stored.
    fn snapshot(&self) -> Result<Vec<u8>, String> {
        Err("its estimator cannot be stored".to_owned())
    }

    /// Goes on as the one that was stored; none, and as before, if these bytes are no snapshot of such a one.
    fn restore(&mut self, _snapshot: &[u8]) -> Option<()> {
        None
    }
}

/// What an estimator did with a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It is not for this estimator.
    NotMine,
    /// It made a difference.
    Taken,
    /// It cannot be true, or came too late.
    Refused,
}

impl Outcome {
    /// Taken or refused.
    pub const fn taken(taken: bool) -> Self {
        if taken { Self::Taken } else { Self::Refused }
    }
}

/// A figure of a stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Panel {
    /// Where everything is.
    Map,
    /// Specific forces.
    Forces,
    /// Angular rates.
    Rates,
    /// Ranges to anchors.
    Ranges,
    /// Path losses.
    Losses,
    /// Angles and rates of an aircraft.
    Angles,
    /// Its airspeed.
    Airspeed,
}

impl Panel {
    /// All, as shown when nobody says which system sends.
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
