#![doc = include_str!("../README.md")]
#![no_std]

mod adaptive;
mod bias;
mod decision;
mod error;
mod judge;
mod measurement;
mod pass;
mod robust;
mod scale;
mod student;
mod update;
mod weight;
mod worst_first;

pub use adaptive::{Adaptive, AnyFactor, Block, Discrepancy, NoFactor, Order};
pub use bias::{Jump, MOST_STATES};
pub use decision::{Decision, Reason, Summary};
pub use error::Error;
pub use measurement::Measurement;
pub use robust::{Reweighting, Robust};
pub use scale::{AnyScale, Scale, UnitScale};
pub use student::student_quantile;
pub use update::jump;
pub use weight::{Descent, Huber, Igg3, TTest, Weight, WeightFunction};
