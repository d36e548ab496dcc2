//! Text of the 9DoF Razor and its descendants, as the walks of Aydın and Erken's paper were logged: time in ms, three
//! accelerations in g and three rates in °/s, separated by blanks; columns beyond the seventh are ignored. Without a
//! header that names as many columns the format is recognised by its shape alone, so the data may overrule it.

use super::{Description, Format};
use crate::dialect::Separator;
use crate::table::Table;

pub(super) const RAZOR: Description = Description {
    format: Format::Razor,
    name: "razor",
    title: "Razor text",
    is_it: Some(is_it),
    time: &[("1", "ms")],
    sensors: ["2", "3", "4", "5", "6", "7"],
    acceleration: "g",
    rate: "deg/s",
    is_a_guess: true,
};

fn is_it(table: &Table) -> bool {
    let is_blank = |separator| matches!(separator, Separator::Blanks | Separator::Tab);
    let blanks = table.dialect.is_some_and(|dialect| is_blank(dialect.separator));
    blanks && table.header.is_none() && table.columns.len() >= 7
}
