//! What can be turned while looking: the same for every system, so that the page knows none of them.

mod control;
mod settings;
mod source;

pub use control::{Choice, Control, Slider, Switch};
pub use settings::Settings;
pub use source::{FileField, Files, Source};

use crate::Error;
use crate::figure::Figure;

/// A recording that is open, and what can be tried on it.
pub trait Explorer: Send + Sync {
    /// What can be turned, and where it stands at first.
    fn controls(&self) -> Vec<Control>;

    /// What comes out as it stands now.
    ///
    /// # Errors
    /// One sentence, as on the command line, if the recording and the settings give nothing.
    fn answer(&self, settings: &Settings) -> Result<Answer, Error>;
}

/// What comes out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Answer {
    /// Numbers with their units, by name.
    pub facts: Vec<(String, String)>,
    /// What a user should know.
    pub warnings: Vec<String>,
    /// Always the same ones in the same order, whatever the settings.
    pub figures: Vec<Figure>,
}

impl Answer {
    /// With another fact.
    pub fn fact(&mut self, name: impl Into<String>, value: impl Into<String>) {
        self.facts.push((name.into(), value.into()));
    }
}
