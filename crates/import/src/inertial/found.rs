//! The findings about a log, as conclusions.

use super::columns::{Axis, Columns};
use super::conclusion::{Conclusion, Source, conclusions};
use super::units::Units;
use crate::formats::Format;
use crate::options::ROLES;
use crate::table::Table;
use crate::{Dialect, Separator};

/// The findings about a log.
pub(super) struct Found<'a> {
    pub(super) table: &'a Table,
    pub(super) columns: &'a Columns,
    pub(super) units: &'a Units,
    /// The number of samples that repeat the one before.
    pub(super) doubles: usize,
    /// The offset that was subtracted from the times, s.
    pub(super) start: f64,
}

impl Found<'_> {
    /// The conclusions, including the notes of the format's reader.
    pub(super) fn conclusions(&self, format: Option<Format>, notes: &[String]) -> Vec<Conclusion> {
        let Units { units: [force, rate, time], sources } = self.units;
        let mut parts = vec![
            (format!("time in {time}"), sources[2]),
            (format!("acceleration in {force}"), sources[0]),
            (format!("angular rate in {rate}"), sources[1]),
        ];
        parts.extend(self.names().map(|names| (format!("columns {names}"), self.columns.source)));
        if let Some(dialect) = self.table.dialect.filter(|&dialect| dialect != PLAIN) {
            parts.push((dialect.to_string(), Source::Data));
        }
        if self.doubles > 0 {
            parts.push((format!("{} samples twice", self.doubles), Source::Data));
        }
        if self.start != 0.0 {
            parts.push((format!("times counted from {} s", self.start), Source::Data));
        }
        let mut conclusions = conclusions(parts);
        let of = |format| move |what| Conclusion { what, from: Source::Format(format) };
        conclusions
            .extend(format.into_iter().flat_map(|format| notes.iter().cloned().map(of(format))));
        conclusions
    }

    /// The columns that were used, unless they are the plain ones or a decoder's own.
    fn names(&self) -> Option<String> {
        let name = |axis: &Axis| {
            let sign = if axis.is_negative { "−" } else { "" };
            format!("{sign}{}", self.table.columns[axis.column].name)
        };
        let time = self.columns.time.map(|time| self.table.columns[time].name.clone());
        let names: Vec<_> = time.into_iter().chain(self.columns.sensors.iter().map(name)).collect();
        let is_usual = match self.table.dialect {
            Some(_) => names == ROLES,
            None => !self.columns.are_said,
        };
        (!is_usual).then(|| names.join(", "))
    }
}

const PLAIN: Dialect = Dialect::new(Separator::Comma, false);
