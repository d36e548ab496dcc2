#![doc = include_str!("../README.md")]

mod clock;
mod containers;
mod damage;
mod dialect;
mod error;
pub mod flight;
mod formats;
mod heading;
pub mod inertial;
mod layout;
pub mod levels;
mod moment;
mod named;
mod names;
mod number;
mod options;
mod part;
pub mod ranging;
mod row;
mod table;
mod text;
mod unit;

pub use clock::{unit_of_range_times, unit_of_times};
pub use damage::{Damage, Fault, Loss};
pub use dialect::{Dialect, Separator};
pub use error::{Complaint, Error};
pub use formats::Format;
pub use heading::{Heading, Place};
pub use layout::Kind;
pub use named::NamedTable;
pub use options::{Columns, Options, TimeUnit, Units};
pub use part::Part;
pub use table::{Column, Table};
pub use text::{Line, Text};
pub use unit::{Quantity, STANDARD_GRAVITY, Unit};
