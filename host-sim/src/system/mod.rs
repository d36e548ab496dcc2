//! The interface of a system to the program: every command uses it, and no system implements a command itself.
//!
//! A [`System`] declares once which files it reads, which settings it has, and how a recording is tracked and
//! evaluated. The command line, the page and live streams are derived from that for every system.

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
