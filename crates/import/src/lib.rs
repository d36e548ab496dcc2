#![doc = include_str!("../README.md")]

mod containers;
mod damage;
mod dialect;
mod error;
mod formats;
pub mod inertial;
mod layout;
mod moment;
mod names;
mod options;
mod part;
mod table;
mod text;
mod unit;

pub use damage::{Damage, Fault, Loss};
pub use dialect::{Dialect, Separator};
pub use error::{Complaint, Error};
pub use formats::Format;
pub use layout::Kind;
pub use options::{Columns, Options, TimeUnit, Units};
pub use part::Part;
pub use table::{Column, Table};
pub use text::{Line, Text};
pub use unit::{Quantity, STANDARD_GRAVITY, Unit};
