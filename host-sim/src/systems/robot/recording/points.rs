//! Marked points of a static recording, true tracks of a moving one, and heights of either.

use std::collections::BTreeMap;
use std::path::Path;

use kestirim_replay::robot::Course;

use crate::Error;
use crate::table;
use crate::text::printable;

/// A point where the tag was put down, with the coordinates that the file has.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Point {
    /// The name of the point.
    pub name: String,
    /// The x and y coordinates (m), used only for accuracy and calibration.
    pub plane: Option<[f64; 2]>,
    /// The z coordinate (m).
    pub height: Option<f64>,
}

/// Reads points in their order: CSV with a column `point` and any of `x,y` and `z` (m).
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read_points(path: &Path) -> Result<Vec<Point>, Error> {
    let mut points: Vec<Point> = Vec::new();
    table::read(
        path,
        "points",
        |header| {
            let [name] = header.require(["point"])?;
            Ok((name, header.all(["x", "y"])?, header.find("z")?))
        },
        |&(name, plane, height), row| {
            let name = row.text(name).into_owned();
            if points.iter().any(|point| point.name == name) {
                let found = printable(&name);
                return Err(row.line.error(format!("expected another point, found {found}")));
            }
            let plane = plane
                .map(|[x, y]| Ok::<_, Error>([row.coordinate("x", x)?, row.coordinate("y", y)?]))
                .transpose()?;
            let height = height.map(|z| row.coordinate("z", z)).transpose()?;
            points.push(Point { name, plane, height });
            Ok(())
        },
    )?;
    Ok(points)
}

/// Reads quantities over time: CSV with a column `t` (s) and the named ones (m).
///
/// # Errors
/// An error that names the file, the line, and what was expected there; times must not decrease.
pub fn read_course<const K: usize>(path: &Path, names: [&str; K]) -> Result<Course<K>, Error> {
    let mut rows: Vec<(i64, [f64; K])> = Vec::new();
    table::read(
        path,
        "a track",
        |header| Ok((header.require(["t"])?, header.require(names)?)),
        |&([t], columns), row| {
            let time_us = row.time_us(t)?;
            if rows.last().is_some_and(|(last_us, _)| time_us < *last_us) {
                return Err(row.line.error(
                    "expected a time not before that of the line above, found an earlier one",
                ));
            }
            let mut values = [0.0; K];
            for ((value, name), column) in values.iter_mut().zip(names).zip(columns) {
                *value = row.coordinate(name, column)?;
            }
            rows.push((time_us, values));
            Ok(())
        },
    )?;
    Ok(Course::new(rows))
}

/// Reads the height of the tag at each point: CSV with columns `point,z` (m).
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read_heights(path: &Path) -> Result<BTreeMap<String, f64>, Error> {
    let mut heights = BTreeMap::new();
    table::read(
        path,
        "heights of points",
        |header| header.require(["point", "z"]),
        |&[name, z], row| {
            heights.insert(row.text(name).into_owned(), row.coordinate("z", z)?);
            Ok(())
        },
    )?;
    Ok(heights)
}
