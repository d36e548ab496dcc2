//! Converts the rows of a table to samples in the log's own units.

use super::columns::{Axis, Columns};
use super::order::Rows;
use super::raw::Raw;
use crate::damage::{Damage, Fault};
use crate::error::quoted;
use crate::table::Table;
use crate::text::{Text, letters};

impl Rows {
    /// The rows that hold a number in every required column.
    pub(super) fn of(
        text: Option<&Text<'_>>,
        table: &Table,
        columns: &Columns,
        damage: &mut Damage,
    ) -> Self {
        let count = table.lines.len();
        let mut rows = Self {
            raw: Vec::with_capacity(count),
            lines: Vec::with_capacity(count),
            places: Vec::with_capacity(count),
        };
        let values = |axis: Axis| {
            (&table.columns[axis.column].values, if axis.is_negative { -1.0 } else { 1.0 })
        };
        let sensors = columns.sensors.map(values);
        let times = columns.time.map(|time| &table.columns[time].values);
        for (i, &line) in table.lines.iter().enumerate() {
            let value =
                |axis: usize| sensors[axis].1 * sensors[axis].0.get(i).copied().unwrap_or(f64::NAN);
            let raw = Raw {
                time: times.map_or(i as f64, |times| times.get(i).copied().unwrap_or(f64::NAN)),
                force: [value(0), value(1), value(2)],
                rate: [value(3), value(4), value(5)],
            };
            let is_finite = raw.time.is_finite()
                && raw.force.iter().all(|x| x.is_finite())
                && raw.rate.iter().all(|x| x.is_finite());
            if is_finite {
                rows.raw.push(raw);
                rows.lines.push(line);
                rows.places.push(i);
            } else {
                damage.add(Fault::Foreign, line, || complaint(text, table, columns, i));
            }
        }
        rows
    }
}

/// Describes what is wrong with a row that lacks a number in a required column.
fn complaint(text: Option<&Text<'_>>, table: &Table, columns: &Columns, row: usize) -> String {
    let needed = columns.time.into_iter().chain(columns.sensors.map(|axis| axis.column));
    let value = |column: usize| table.columns[column].values.get(row).copied();
    let mut wrong = needed.filter(|&column| value(column).is_none_or(|value| !value.is_finite()));
    let column = wrong.next().unwrap_or_default();
    let found = match (text, table.dialect) {
        (Some(text), Some(dialect)) => {
            let fields = dialect.fields(text.line(table.lines[row]));
            quoted(&fields.get(column).map(|field| letters(field)).unwrap_or_default())
        }
        _ => value(column).unwrap_or(f64::NAN).to_string(),
    };
    let name = &table.columns[column].name;
    format!("expected a finite number in column {name}, found {found}")
}
