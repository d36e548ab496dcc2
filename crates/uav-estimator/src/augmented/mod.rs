//! A filter of more than the four states: what gusts, wind, biases and a wrong trim add to them.

mod discretise;
mod filter;
mod flight;
mod model;
mod output;

pub use filter::{AugmentedFilter, AugmentedTransition};
pub use flight::AugmentedFlight;
pub use model::{AugmentedModel, AugmentedStep, Drift, Gust};
pub use output::{Output, Reference};
