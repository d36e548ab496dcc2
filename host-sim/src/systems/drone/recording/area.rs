//! The file of the area that the user is known to be in.

use std::path::Path;

use kestirim_replay::drone::{Area, MOST_CORNERS};

use super::plane::{Origin, Places};
use crate::Error;
use crate::table;

/// Reads the corners of an area in order, from columns x,y, or lat,lon if the log has these.
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read(path: &Path, mut origin: Option<Origin>) -> Result<Box<Area>, Error> {
    let mut corners = Vec::new();
    table::read(
        path,
        "the corners of an area",
        move |header| Places::find(header)?.as_in_log(header, origin),
        |places, row| {
            if corners.len() == MOST_CORNERS {
                let problem = format!("expected at most {MOST_CORNERS} corners, found one more");
                return Err(row.line.error(problem));
            }
            corners.push(places.read(row, &mut origin)?);
            Ok(())
        },
    )?;
    match Area::new(&corners) {
        Ok(area) if area.size() >= 1.0 => Ok(Box::new(area)),
        _ => {
            let problem =
                "expected the corners of an area of a square metre at least, one after the other";
            Err(Error::File { path: path.to_path_buf(), problem: problem.to_owned() })
        }
    }
}
