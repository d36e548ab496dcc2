//! A table of numbers, whatever separates them.

use crate::damage::{Damage, Fault};
use crate::dialect::Dialect;
use crate::error::Error;
use crate::layout::{Kind, Layout};
use crate::moment;
use crate::row::Row;
use crate::text::{Line, Text};

/// A column of a [`Table`].
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// The name in the header, including a unit that stands there; without a header, the column's number, from 1.
    pub name: String,
    /// The unit from a line of units below the header.
    pub unit: Option<String>,
    /// What the column holds.
    pub kind: Kind,
    /// One value for each row, NaN where it is missing; empty if the column holds words.
    pub values: Vec<f64>,
}

/// A table of numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// How the table is written, if it is text.
    pub dialect: Option<Dialect>,
    /// The line of the header, if there is one.
    pub header: Option<usize>,
    /// The line number and the words directly above the first row that are not a header, because there are more or
    /// fewer of them than columns.
    pub other_header: Option<(usize, Vec<String>)>,
    /// The columns, in the order of the log.
    pub columns: Vec<Column>,
    /// The line or record of each row.
    pub lines: Vec<usize>,
    /// The number of lines above the rows that are neither header nor comment.
    pub above: usize,
    /// The number of comment lines.
    pub comments: usize,
    /// The lines whose number of fields differs from the number of columns, or the records that cannot be read.
    pub damage: Damage,
}

impl Table {
    /// Reads a table. Comments are skipped; damaged lines are skipped and counted.
    ///
    /// # Errors
    /// [`Error::Log`] if there is no table of numbers.
    pub fn read(text: &Text<'_>) -> Result<Self, Error> {
        let layout = Layout::find(text)?;
        let dialect = layout.dialect;
        let width = layout.names.len();
        // Each row takes at least two bytes a column.
        let rows = (text.breaks() + 1).min(text.len() / (2 * width) + 1);
        let columns = layout.names.into_iter().zip(layout.units).zip(layout.kinds);
        let columns: Vec<_> = columns
            .map(|((name, unit), kind)| {
                let rows = if kind == Kind::Words { 0 } else { rows };
                Column { name, unit, kind, values: Vec::with_capacity(rows) }
            })
            .collect();
        let mut table = Self {
            dialect: Some(dialect),
            header: layout.header,
            other_header: layout.other_header,
            columns,
            lines: Vec::with_capacity(rows),
            above: 0,
            comments: 0,
            damage: Damage { end_may_be_cut: !text.ends_with_line_break(), ..Damage::default() },
        };
        table.read_rows(text, dialect, layout.first_row);
        Ok(table)
    }

    /// A table of columns decoded from a binary format: their names and values, and the record of each row.
    pub(crate) fn decoded(
        columns: impl IntoIterator<Item = (String, Vec<f64>)>,
        lines: Vec<usize>,
        damage: Damage,
    ) -> Self {
        let column = |(name, values)| Column { name, unit: None, kind: Kind::Number, values };
        Self {
            dialect: None,
            header: None,
            other_header: None,
            columns: columns.into_iter().map(column).collect(),
            lines,
            above: 0,
            comments: 0,
            damage,
        }
    }

    /// Whether the columns have names; those of a text without a header only have numbers.
    pub fn has_names(&self) -> bool {
        self.header.is_some() || self.dialect.is_none()
    }

    fn read_rows(&mut self, text: &Text<'_>, dialect: Dialect, first_row: usize) {
        let width = self.columns.len();
        let mut row = vec![f64::NAN; width];
        let mut torn: Option<(Line<'_>, usize)> = None;
        for line in text.lines() {
            if Some(line.number) == self.header {
                continue;
            }
            if dialect.is_comment(line.bytes) {
                self.comments += 1;
                continue;
            }
            if line.number < first_row {
                self.above += 1;
                continue;
            }
            if let Some((torn, found)) = torn.take() {
                self.leave_out(Fault::Torn, torn, found);
            }
            match self.read_row(dialect, line.bytes, &mut row) {
                Ok(()) => {
                    for (column, &value) in self.columns.iter_mut().zip(&row) {
                        if column.kind != Kind::Words {
                            column.values.push(value);
                        }
                    }
                    self.lines.push(line.number);
                }
                Err(found) => torn = Some((line, found)),
            }
        }
        // A damaged line at the very end was cut off.
        if let Some((torn, found)) = torn {
            let fault = if found < width { Fault::Cut } else { Fault::Torn };
            self.leave_out(fault, torn, found);
        }
    }

    fn leave_out(&mut self, fault: Fault, line: Line<'_>, found: usize) {
        let (expected, header) = (self.columns.len(), self.header.is_some());
        let like = if header { "as in the header" } else { "as in the first row" };
        self.damage.add(fault, line.number, || {
            format!("expected {expected} fields {like}, found {found}")
        });
    }

    /// Reads the fields of a line into a row.
    ///
    /// # Errors
    /// The number of fields, if it differs from the number of columns.
    fn read_row(&self, dialect: Dialect, line: &[u8], values: &mut [f64]) -> Result<(), usize> {
        let mut row = Row::new(dialect, dialect.trimmed(line));
        for (column, value) in self.columns.iter().zip(values.iter_mut()) {
            let number = if column.kind == Kind::Number { row.number() } else { None };
            *value = match number {
                Some(number) => number,
                None => match row.field() {
                    Some(field) => value_of(dialect, column.kind, field).unwrap_or(f64::NAN),
                    None => return self.read_fields(dialect, line, values),
                },
            };
        }
        // A line may end with a separator.
        if row.is_at_end() { Ok(()) } else { self.read_fields(dialect, line, values) }
    }

    /// Slow path of [`Self::read_row`], for quoted fields and lines with another number of fields.
    fn read_fields(&self, dialect: Dialect, line: &[u8], row: &mut [f64]) -> Result<(), usize> {
        let fields = dialect.fields(line);
        let width = self.columns.len();
        let ends = fields.len() == width + 1 && fields.last().is_some_and(|last| last.is_empty());
        if fields.len() != width && !ends {
            return Err(fields.len());
        }
        for ((column, value), field) in self.columns.iter().zip(row).zip(&fields) {
            *value = value_of(dialect, column.kind, field).unwrap_or(f64::NAN);
        }
        Ok(())
    }
}

fn value_of(dialect: Dialect, kind: Kind, field: &[u8]) -> Option<f64> {
    match kind {
        Kind::Number => dialect.number(field),
        Kind::Date | Kind::TimeOfDay => moment::read(field).map(moment::Moment::microseconds),
        Kind::Words => None,
    }
}

#[cfg(test)]
mod tests {
    use rand_core::{Rng, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;
    use crate::dialect::Separator;

    fn read(text: &str) -> Table {
        Table::read(&Text::new(text.as_bytes()).unwrap()).unwrap()
    }

    #[test]
    fn columns_have_names_units_and_values() {
        let table = read(
            "Device: x\n# made by hand\nt;x;note;at\ns;m;;\n0,5;2;#;10:00:00\n\n1;;a b;10:00:01\n",
        );
        assert_eq!((table.header, table.above, table.comments), (Some(3), 2, 1));
        let names: Vec<_> = table.columns.iter().map(|column| column.name.as_str()).collect();
        assert_eq!(names, ["t", "x", "note", "at"]);
        assert_eq!(table.columns[1].unit.as_deref(), Some("m"));
        assert_eq!(table.columns[0].values, [0.5, 1.0]);
        assert!(table.columns[1].values[1].is_nan());
        assert_eq!(table.columns[2].values, []);
        assert_eq!(table.columns[3].values, [36e9, 36_001e6]);
        assert_eq!(table.lines, [5, 7]);
    }

    #[test]
    fn lines_of_another_width_are_counted() {
        let table = read("a,b,c\n1,2,3\n4,5\n6,7,8,9\n1,2,3\n1,2,3,\n1,2");
        assert_eq!(table.lines, [2, 5, 6]);
        let losses: Vec<_> =
            table.damage.losses.iter().map(|loss| (loss.fault, loss.lines.clone())).collect();
        assert_eq!(losses, [(Fault::Torn, vec![3, 4]), (Fault::Cut, vec![7])]);
        assert!(table.damage.end_may_be_cut);
    }

    #[test]
    fn a_header_may_be_a_comment_or_missing() {
        assert_eq!(read("# t, x\n1 2\n3 4\n").columns[1].name, "x");
        assert_eq!(read("1 2\n3 4\n").columns[1].name, "2");
        assert_eq!(read("a b c\n1 2\n").other_header.unwrap().1, ["a", "b", "c"]);
    }

    #[test]
    fn any_line_is_read_as_its_list_of_fields() {
        const LETTERS: &[u8] = b"1234567890,,,;;;\t\t   ..--+eE\"x:\r\x0c";
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
        let of_width = |width| {
            let mut table = read("a,b,c,d\n1,2,10:00:00,x\n");
            table.columns.truncate(width);
            table
        };
        let tables = [1, 2, 3, 4].map(of_width);
        let bits = |row: [f64; 4]| row.map(f64::to_bits);
        let mut whole = 0;
        for round in 0..300_000 {
            let separators =
                [Separator::Comma, Separator::Semicolon, Separator::Tab, Separator::Blanks];
            let dialect = Dialect::new(separators[round % 4], round % 8 > 3);
            let length = 1 + rng.next_u32() as usize % 16;
            let letter = |_| LETTERS[rng.next_u32() as usize % LETTERS.len()];
            let line: Vec<_> = (0..length).map(letter).collect();
            let line = line.trim_ascii();
            let table = &tables[rng.next_u32() as usize % 4];
            let (mut quick, mut slow) = ([0.0; 4], [0.0; 4]);
            let found = table.read_row(dialect, line, &mut quick);
            let shown = String::from_utf8_lossy(line);
            assert_eq!(found, table.read_fields(dialect, line, &mut slow), "{dialect}: {shown:?}");
            if found.is_ok() {
                whole += 1;
                assert_eq!(bits(quick), bits(slow), "{dialect}: {shown:?}");
            }
        }
        assert!(whole > 10_000, "{whole}");
    }
}
