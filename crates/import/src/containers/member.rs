//! One sensor's text among several in an archive.

use super::gather::Stream;
use crate::damage::{Damage, Fault};
use crate::error::Error;
use crate::names::split_unit;
use crate::part::Part;
use crate::table::Table;
use crate::text::Text;
use crate::unit::{Quantity, Unit};

/// Reads three axes of a sensor and their times: the rows that hold numbers for all of them, in SI units if the names
/// give units. The axes fill the columns of the accelerometer or of the gyroscope.
///
/// # Errors
/// If there is no such table, or one of the columns is missing.
pub(super) fn read(
    bytes: &[u8],
    file: &'static str,
    time: &str,
    quantity: Quantity,
) -> Result<(Stream, Damage), Error> {
    let of_file = |error: Error| Error::log(format!("{file}: {error}"));
    let text = Text::new(bytes).map_err(of_file)?;
    let mut table = Table::read(&text).map_err(of_file)?;
    let mut damage = std::mem::take(&mut table.damage).named(Part::LineOf(file));
    let find = |test: &dyn Fn(&str) -> bool, what: &str| {
        let found = table.columns.iter().find(|column| test(&column.name));
        found.filter(|column| !column.values.is_empty()).ok_or_else(|| {
            let names = table.columns.iter().map(|column| column.name.as_str());
            let found = crate::error::listed(names);
            Error::log(format!("expected a column {what} in {file}, found {found}"))
        })
    };
    let times = &find(&|name| name == time, time)?.values;
    let mut axes = [(times, 1.0); 3];
    for (slot, axis) in axes.iter_mut().zip(["x", "y", "z"]) {
        // `x`, `X (m/s^2)`, `Acceleration x (m/s^2)`
        let is_axis = |name: &str| {
            let (bare, _) = split_unit(name);
            bare.rsplit(' ').next().is_some_and(|word| word.eq_ignore_ascii_case(axis))
        };
        let column = find(&is_axis, axis)?;
        let unit = split_unit(&column.name).1.and_then(|unit| Unit::read(quantity, unit));
        *slot = (&column.values, unit.map_or(1.0, |unit| unit.scale));
    }
    let mut stream = Stream::default();
    for (i, &line) in table.lines.iter().enumerate() {
        let time = times.get(i).copied().unwrap_or(f64::NAN);
        let [x, y, z] =
            axes.map(|(values, scale)| values.get(i).map_or(f64::NAN, |value| value * scale));
        if [time, x, y, z].iter().all(|value| value.is_finite()) {
            stream.push(
                line,
                match quantity {
                    Quantity::Acceleration => [time, x, y, z, 0.0, 0.0, 0.0],
                    _ => [time, 0.0, 0.0, 0.0, x, y, z],
                },
            );
        } else {
            damage.add(Fault::Foreign, line, || {
                "expected numbers of time, x, y and z, found something else".to_owned()
            });
        }
    }
    Ok((stream, damage))
}
