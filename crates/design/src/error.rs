use kestirim_observer_design::{self as design, Mode};

use crate::MOST_STATES;

/// Why there is no design.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No states, or too many.
    #[error("expected 1 to {MOST_STATES} states, found {0}")]
    States(usize),
    /// There are not as many poles, or names of states, as states.
    #[error("expected {states} poles and as many names of states")]
    Poles {
        /// How many states there are.
        states: usize,
    },
    /// Modes that no output sees.
    #[error("no output sees the mode{} {}", if .0.len() == 1 { "" } else { "s" }, names(.0))]
    Unobservable(Vec<Mode>),
    /// What the design itself refuses.
    #[error("{0}")]
    Design(#[from] design::Error),
}

fn names(modes: &[Mode]) -> String {
    modes.iter().map(Mode::to_string).collect::<Vec<_>>().join(", ")
}
