//! Files of anchor positions.

use std::path::Path;

use kestirim_replay::robot::{Anchors, MOST};

use crate::Error;
use crate::table;
use crate::text::printable;

/// Reads anchors: CSV with columns `anchor,x,y,z` (m).
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read(path: &Path) -> Result<Anchors, Error> {
    let mut anchors = Anchors::default();
    table::read(
        path,
        "anchors",
        |header| header.require(["anchor", "x", "y", "z"]),
        |&[name, x, y, z], row| {
            let position =
                [row.coordinate("x", x)?, row.coordinate("y", y)?, row.coordinate("z", z)?];
            let name = row.text(name);
            if name.is_empty() || anchors.find(&name).is_some() {
                let found = printable(&name);
                return Err(row.line.error(format!("expected another anchor, found {found}")));
            }
            if anchors.names.len() == MOST {
                return Err(row.line.error(format!("expected at most {MOST} anchors")));
            }
            anchors.names.push(name.into_owned());
            anchors.positions.push(position);
            Ok(())
        },
    )?;
    Ok(anchors)
}
