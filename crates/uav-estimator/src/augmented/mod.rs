//! A filter with more than the four states, for gusts, wind, biases and a wrong trim.

mod discretise;
mod filter;
mod flight;
mod grid;
mod local;
mod model;
mod output;
mod row;
mod scheduled_filter;
mod scheduled_flight;

pub use filter::{AugmentedFilter, AugmentedTransition};
pub use flight::AugmentedFlight;
pub use grid::ScheduledTransition;
pub use local::LocalModel;
pub use model::{AugmentedModel, AugmentedStep, Drift, Gust};
pub use output::{Output, Reference};
pub use scheduled_filter::ScheduledFilter;
pub use scheduled_flight::ScheduledFlight;
