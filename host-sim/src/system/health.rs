//! Whether an answer can be relied upon, in the same words for every system.

use serde::Serialize;

/// How far an answer can be relied upon.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum State {
    /// As its standard deviation says.
    #[default]
    Good,
    /// Worse than with better data; what is said of its accuracy still holds, more or less.
    Degraded,
    /// It may be wrong by far more than anything says.
    Bad,
}

/// Why an answer is not good.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// A sensor was at its end.
    Saturated,
    /// A sensor repeated itself.
    Stuck,
    /// Data are missing, or too few.
    Dropout,
    /// More measurements than usual contradict the estimate and were left out.
    Rejected,
    /// What the estimate needs cannot be seen in the data.
    NotObservable,
    /// Times run too fast or too slow, or products belong to another time.
    Time,
    /// Data seem to be in another unit, or of another sign.
    Units,
    /// Axes seem to be swapped or mirrored.
    Axes,
    /// Measurements and geometry contradict each other.
    Geometry,
    /// One anchor, or two that seem swapped, contradict the others.
    Anchor,
    /// The height that was said contradicts the measurements.
    Height,
    /// What is left of the measurements is beyond its bound.
    Innovations,
    /// The estimate left the range of its numbers.
    Range,
}

impl State {
    /// As a field of a table has it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Degraded => "degraded",
            Self::Bad => "bad",
        }
    }
}

impl Reason {
    /// How far an answer can be relied upon for all that.
    pub fn state(self) -> State {
        match self {
            Self::Saturated
            | Self::Stuck
            | Self::Dropout
            | Self::Rejected
            | Self::NotObservable => State::Degraded,
            Self::Time
            | Self::Units
            | Self::Axes
            | Self::Geometry
            | Self::Anchor
            | Self::Height
            | Self::Innovations
            | Self::Range => State::Bad,
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Saturated => "saturated",
            Self::Stuck => "stuck",
            Self::Dropout => "dropout",
            Self::Rejected => "rejected",
            Self::NotObservable => "not observable",
            Self::Time => "time",
            Self::Units => "units",
            Self::Axes => "axes",
            Self::Geometry => "geometry",
            Self::Anchor => "anchor",
            Self::Height => "height",
            Self::Innovations => "innovations",
            Self::Range => "range",
        }
    }
}

/// Whether an answer can be relied upon, and if not, why.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Health {
    /// How far.
    pub state: State,
    /// Why not further, each once.
    pub reasons: Vec<Reason>,
}

impl Health {
    /// With another reason.
    pub fn add(&mut self, reason: Reason) {
        self.state = self.state.max(reason.state());
        if let Err(place) = self.reasons.binary_search(&reason) {
            self.reasons.insert(place, reason);
        }
    }

    /// As people read it.
    pub fn in_words(&self) -> String {
        let state = self.state.word();
        if self.reasons.is_empty() {
            return state.to_owned();
        }
        let reasons: Vec<_> = self.reasons.iter().map(|reason| reason.words()).collect();
        format!("{state}: {}", reasons.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_reason_decides() {
        let mut health = Health::default();
        assert_eq!(health.in_words(), "good");
        health.add(Reason::Dropout);
        assert_eq!(health.in_words(), "degraded: dropout");
        health.add(Reason::Anchor);
        health.add(Reason::Saturated);
        health.add(Reason::Anchor);
        assert_eq!(health.in_words(), "bad: saturated, dropout, anchor");
        let written = serde_json::to_string(&health).unwrap();
        assert_eq!(written, r#"{"state":"bad","reasons":["saturated","dropout","anchor"]}"#);
    }
}
