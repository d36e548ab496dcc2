//! Texts `data_inert.txt` of `OpenShoe` (KTH, ISC licence), as `settings.m` of its Matlab implementation reads them: a
//! header of 32 words, then `%x  %f %f %f  %f %f %f  %i %x  %i  %f %f %f  %f  %f %f %f`.
//!
//! Texts of the first prototype, with a `MicroStrain` 3DM-GX2, name their columns: a byte, three accelerations in g,
//! three rates in rad/s, a counter, a checksum, a number, three times in s since 1970, of which the first is filtered,
//! Hz, G. These names contain blanks, so columns are identified by their positions. Texts that
//! `logging_inertial_data.m` writes for the embedded module have a header of 32 dummies, m/s² and rad/s, and zeros for
//! the rest: their samples are only numbered.
//!
//! The output of the module itself is read by [`crate::containers::MIMU`].

use super::{Description, Format};
use crate::table::Table;

/// The columns of the six axes, in both formats.
const SENSORS: [&str; 6] = ["2", "3", "4", "5", "6", "7"];
/// The number of columns, including those of a magnetometer.
const COLUMNS: usize = 17;
/// The number of columns without those of a magnetometer.
const FEWEST_COLUMNS: usize = 14;

pub(super) const OPENSHOE: Description = Description {
    format: Format::OpenShoe,
    name: "openshoe",
    title: "OpenShoe text",
    is_it: Some(is_named),
    time: &[("11", "s")],
    sensors: SENSORS,
    acceleration: "g",
    rate: "rad/s",
    is_a_guess: false,
};

pub(super) const OPENSHOE_COUNTED: Description = Description {
    format: Format::OpenShoeCounted,
    name: "openshoe-counted",
    title: "OpenShoe text without times",
    is_it: Some(is_counted),
    time: &[],
    sensors: SENSORS,
    acceleration: "m/s2",
    rate: "rad/s",
    is_a_guess: false,
};

fn is_named(table: &Table) -> bool {
    let begins_with = ["Header:", "a_x", "[g]:", "a_y", "[g]:", "a_z", "[g]:", "ar_x", "[rad/s]:"];
    has_words(table, |words| words.starts_with(&begins_with))
}

fn is_counted(table: &Table) -> bool {
    has_words(table, |words| words.iter().all(|&word| word == "dummy_header"))
}

/// Whether a table has a plausible number of columns, and words above them that `are_these` accepts.
fn has_words(table: &Table, are_these: impl Fn(&[&str]) -> bool) -> bool {
    (FEWEST_COLUMNS..=COLUMNS).contains(&table.columns.len())
        && table.other_header.as_ref().is_some_and(|(_, words)| {
            are_these(&words.iter().map(String::as_str).collect::<Vec<_>>())
        })
}
