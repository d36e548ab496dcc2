use kestirim_observer_design::{self as design, Mode};

use crate::MOST_STATES;

/// Reason why a design failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// There are no states, or more than [`MOST_STATES`].
    #[error("expected 1 to {MOST_STATES} states, found {0}")]
    States(usize),
    /// The number of poles, or of names of states, differs from the number of states.
    #[error("expected {states} poles and as many names of states")]
    Poles {
        /// Number of states.
        states: usize,
    },
    /// A matrix has another size than the others require; there are at most [`MOST_WIDE`](crate::MOST_WIDE) outputs and inputs.
    #[error("expected a matrix of {} x {}, found {} x {}", .expected[0], .expected[1], .found[0], .found[1])]
    Size {
        /// Its rows and columns.
        found: [usize; 2],
        /// The rows and columns that it should have.
        expected: [usize; 2],
    },
    /// These modes are seen by no output.
    #[error("no output sees the mode{} {}", if .0.len() == 1 { "" } else { "s" }, names(.0))]
    Unobservable(Vec<Mode>),
    /// The design itself was refused.
    #[error("{0}")]
    Design(#[from] design::Error),
}

fn names(modes: &[Mode]) -> String {
    modes.iter().map(Mode::to_string).collect::<Vec<_>>().join(", ")
}
