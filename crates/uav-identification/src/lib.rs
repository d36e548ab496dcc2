#![doc = include_str!("../README.md")]

mod accuracy;
mod compatibility;
mod error;
mod fit;
mod flight;
mod identify;
mod innovations;
mod likelihood;
mod model;
mod nondimensional;
mod parameter;
mod plausible;
mod report;
mod scoring;
mod start;
mod structure;

pub use self::accuracy::Whiteness;
pub use self::compatibility::{Comparison, Compatibility};
pub use self::error::Error;
pub use self::fit::Fit;
pub use self::flight::Flight;
pub use self::identify::{Correlation, Identified, Known, Parameter, identify};
pub use self::model::{Affine, Bias, Drift, Gust, Model, Noise, Trim};
pub use self::nondimensional::{Airplane, Coefficient};
pub use self::parameter::STATES;
