//! The systems, one folder each, with the same rooms.

pub mod gnss;
pub mod pedestrian;

use crate::system::AnySystem;

/// Every system, in the order in which they run: the one list.
pub static ALL: [&dyn AnySystem; 2] = [&pedestrian::Pedestrian, &gnss::Gnss];
