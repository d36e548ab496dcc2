#![doc = include_str!("../README.md")]
#![no_std]

mod augmented;
mod dynamics;
mod error;
mod estimator;
mod flight_filter;
mod flight_observer;
mod gain;
mod gate;
mod innovation_gate;
mod kalman_filter;
mod lateness;
mod monitor;
mod sample;
#[cfg(feature = "serde")]
mod snapshot;
mod transitions;
mod watch;

pub use augmented::{
    AugmentedFilter, AugmentedFlight, AugmentedModel, AugmentedStep, AugmentedTransition, Drift,
    Gust, LocalModel, Output, Reference, ScheduledFilter, ScheduledFlight, ScheduledTransition,
};
pub use dynamics::{Dynamics, Step};
pub use error::Error;
pub use estimator::Estimator;
pub use flight_filter::FlightFilter;
pub use flight_observer::FlightObserver;
pub use gain::{current_gain, observer_gain};
pub use kalman_filter::{KalmanFilter, Transition};
pub use kestirim_health::{Health, Reason};
pub use sample::{Noise, Sample};
