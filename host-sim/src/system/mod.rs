//! What a system is to the program: one face, which every command knows and no system writes twice.
//!
//! A [`System`] says once which files it reads, what can be set, how a recording is tracked and what came of it.
//! The command line, the page and a live stream are made from that, for any system.

mod account;
mod answers;
mod any;
mod face;
mod files;
mod idle;
mod kind;
mod literal;
mod online;
mod opened;
mod outputs;
mod reading;
mod recognised;
mod recorded;
mod run;
mod setting;
mod settings;
mod sheet;
mod shown;

pub use account::{Account, Answer, Table};
pub use any::{AnySystem, Experiment, experiment, tried};
pub use face::{Calibration, Detail, OutputField, System};
pub use files::{FileField, Files, Source};
pub use idle::Idle;
pub use kestirim_health::{Health, Reason, State as HealthState};
pub use kestirim_replay::{Finding, ScalarKind};
pub use kind::{Kind, Named, Number, Value as SettingValue};
pub use literal::Literal;
pub use online::{Online, Outcome, Panel, Plan};
pub use opened::{Opened, Wanted};
pub use outputs::{Outputs, say_where};
pub use reading::Reading;
pub(crate) use recognised::Recognised;
pub use recorded::{DataFile, Making, Measure, Over, Recorded, Study, Together};
pub use run::{RunOptions, choose_scalar};
pub use setting::{Given, Setting, Shorthand};
pub use settings::Settings;
pub use sheet::{Excerpt, Sheet};
