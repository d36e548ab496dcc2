//! Tables whose columns are found by name, with any separator; every error names the file and the line.

use std::borrow::Cow;
use std::cell::RefCell;
use std::path::Path;

use kestirim_import::{
    Damage, Error as ImportError, Fault, Heading, NamedTable, Options, Text, Unit,
    unit_of_range_times, unit_of_times,
};

use crate::Error;
use crate::text::{self, listed, printable};

/// The largest plausible time in seconds: three centuries, within which a double resolves microseconds.
const LATEST_TIME: f64 = 1e10;
/// The largest plausible coordinate in metres, beyond any place on earth in any projection.
pub(crate) const FARTHEST_POSITION: f64 = 1e8;

/// The maximum number of unused columns named in a message.
pub(crate) const MOST_NAMED: usize = 12;

/// How a log was read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Found {
    /// The conclusions about columns and units, and what they are based on.
    pub import: Vec<String>,
    /// Warnings about what was skipped.
    pub warnings: Vec<String>,
}

/// A log to be read.
#[derive(Debug, Clone, Copy)]
pub struct Log<'a> {
    /// A description of the contents, for error messages.
    pub what: &'a str,
    /// The usual range of the time between lines, in seconds: a step outside it means that times are in another unit.
    /// `None` if the step says nothing.
    pub usual_step_s: Option<[f64; 2]>,
    /// The user's description of the log.
    pub options: &'a Options,
}

/// Reads a table, calling `row` for each line below the header. The first damaged line is an error.
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read<T>(
    path: &Path,
    what: &str,
    columns: impl Fn(&Header<'_>) -> Result<T, Error>,
    row: impl FnMut(&T, &Row<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let options = Options { strict: true, ..Options::default() };
    let table = Log { what, usual_step_s: None, options: &options };
    read_log(path, &table, columns, row).map(drop)
}

/// Whether a file is a table with these columns, judged by its beginning.
pub fn has<const N: usize>(path: &Path, names: [&str; N]) -> bool {
    let options = Options { strict: true, ..Options::default() };
    let table = Log { what: "a table", usual_step_s: None, options: &options };
    let header = |header: &Header<'_>| header.require(names);
    text::beginning(path)
        .is_ok_and(|bytes| parse(path, &bytes, &table, header, |_, _| Ok(())).is_ok())
}

/// Reads a log: like [`read`], but up to a hundredth of its lines may be damaged. Lines that `row` refuses, without
/// having changed anything, are skipped and counted.
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read_log<T>(
    path: &Path,
    log: &Log<'_>,
    columns: impl Fn(&Header<'_>) -> Result<T, Error>,
    row: impl FnMut(&T, &Row<'_>) -> Result<(), Error>,
) -> Result<Found, Error> {
    parse(path, &text::unpacked(path)?, log, columns, row)
}

/// Reads the contents of the file `path` as [`read_log`] does.
///
/// # Errors
/// Those of [`read_log`].
pub fn parse<T>(
    path: &Path,
    bytes: &[u8],
    log: &Log<'_>,
    columns: impl Fn(&Header<'_>) -> Result<T, Error>,
    mut row: impl FnMut(&T, &Row<'_>) -> Result<(), Error>,
) -> Result<Found, Error> {
    let Log { what, usual_step_s, options } = *log;
    let file = |problem: String| Error::File { path: path.to_path_buf(), problem };
    let nothing = || file(format!("expected {what}, found an empty file"));
    let text = Text::new(bytes).map_err(|_| nothing())?;
    let found = NamedTable::find(&text, options, |heading| {
        let header = Header { path, heading, found: RefCell::default() };
        let columns = columns(&header)?;
        let left_out = header.left_out();
        Ok::<_, Error>((columns, header.found.into_inner(), left_out))
    });
    let (table, (columns, places, left_out)) = found.ok_or_else(nothing)??;
    let mut import = conclusions(&table, &places);
    import.extend(left_out);
    let mut second = 1.0;
    if let Some(usual) = usual_step_s {
        let unit = unit_of_time(&table, &places, usual).map_err(|error| refused(path, &error))?;
        if let Some(unit) = unit.filter(|unit| unit.scale != 1.0) {
            second = unit.scale;
            import.push(format!("time in {unit}: from the data"));
        }
    }
    let (mut damage, mut total) = (Damage::default(), 0);
    for (number, fields) in table.rows() {
        total += 1;
        let line = Line { path, number };
        let result =
            fields_of(&table, line, fields, second).and_then(|row_of| row(&columns, &row_of));
        if let Err(error) = result {
            let Error::Line { problem, .. } = error else { return Err(error) };
            damage.add(Fault::Unusable, number, || problem);
        }
    }
    if total == 0 {
        return Err(file(format!("expected {what}, found only a header")));
    }
    damage.accept(total, options.strict).map_err(|error| refused(path, &error))?;
    damage.end_may_be_cut = !options.strict && !text.ends_with_line_break();
    Ok(Found { import, warnings: damage.sentences() })
}

/// Converts an error of the importer to one that names the file.
pub fn refused(path: &Path, error: &ImportError) -> Error {
    let path = path.to_path_buf();
    match error {
        ImportError::Line { line, problem } => {
            Error::Line { path, line: *line, problem: problem.clone() }
        }
        other => Error::File { path, problem: other.to_string() },
    }
}

fn fields_of<'a>(
    table: &'a NamedTable<'a>,
    line: Line<'a>,
    fields: Vec<Cow<'a, [u8]>>,
    second: f64,
) -> Result<Row<'a>, Error> {
    let (expected, found) = (table.heading.names().len(), fields.len());
    if expected == found {
        return Ok(Row { line, table, fields, second });
    }
    Err(line.error(format!("expected {expected} fields as in the header, found {found}")))
}

/// Infers the unit of a time column from its spacing if none is stated; `None` for dates and times of day.
fn unit_of_time(
    table: &NamedTable<'_>,
    places: &[(String, Column, String)],
    [shortest, longest]: [f64; 2],
) -> Result<Option<Unit>, ImportError> {
    let time = places.iter().find(|(wanted, column, _)| wanted == "t" && !column.has_unit);
    let Some((_, column, _)) = time else { return Ok(None) };
    let mut has_moments = false;
    let times = table.rows().filter_map(|(_, fields)| {
        let field = fields.get(column.at)?;
        has_moments |= table.is_moment(field);
        table.number(field).filter(|time| time.is_finite())
    });
    let unit = if places.iter().any(|(wanted, ..)| wanted == "range") {
        unit_of_range_times(times, shortest..=longest)
    } else {
        unit_of_times(times, shortest..=longest)
    };
    if has_moments { Ok(None) } else { unit.map(Some) }
}

/// The conclusions about columns whose names or units are not the documented ones.
fn conclusions(table: &NamedTable<'_>, places: &[(String, Column, String)]) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    for (wanted, _, told) in places {
        if told != wanted && !parts.contains(told) {
            parts.push(told.clone());
        }
    }
    if table.dialect.separator != kestirim_import::Separator::Comma {
        parts.push(table.dialect.to_string());
    }
    if parts.is_empty() { Vec::new() } else { vec![format!("{}: header", parts.join(", "))] }
}

/// A column found in the header.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    at: usize,
    /// The factor from the column's unit to the SI unit.
    scale: f64,
    /// Whether the header or an option states the unit.
    has_unit: bool,
}

impl Column {
    const NONE: Self = Self { at: 0, scale: 1.0, has_unit: false };
}

/// The header of a table.
#[derive(Debug)]
pub struct Header<'a> {
    path: &'a Path,
    heading: &'a Heading<'a>,
    /// The columns found: the name asked for, the column, and how to describe it to the user.
    found: RefCell<Vec<(String, Column, String)>>,
}

impl Header<'_> {
    /// An error about the header.
    pub fn error(&self, problem: impl Into<String>) -> Error {
        Line { path: self.path, number: self.heading.line }.error(problem)
    }

    /// The error that there is no column of this name, or of these names.
    pub fn lacks(&self, names: &str) -> Error {
        refused(self.path, &self.heading.lacks(names))
    }

    /// Finds the column `name`, if there is one, under exactly this name or a usual synonym. Names other than those
    /// known to the importer are case-sensitive: `T` may well be a temperature.
    ///
    /// # Errors
    /// [`Error::Line`] if two columns match.
    pub fn find(&self, name: &str) -> Result<Option<Column>, Error> {
        let place = self.heading.find(name).map_err(|error| refused(self.path, &error))?;
        Ok(place.map(|place| {
            let column =
                Column { at: place.column, scale: place.scale(), has_unit: place.unit.is_some() };
            let unit = place.unit.as_ref().map(|unit| format!(" in {unit}"));
            let named = if place.name == name {
                name.to_owned()
            } else {
                format!("{name} = {}", place.name)
            };
            let told = format!("{named}{}", unit.unwrap_or_default());
            self.found.borrow_mut().push((name.to_owned(), column, told));
            column
        }))
    }

    /// Finds all columns `names`.
    ///
    /// # Errors
    /// [`Error::Line`] if a column is missing, or two match.
    pub fn require<const N: usize>(&self, names: [&str; N]) -> Result<[Column; N], Error> {
        let mut columns = [Column::NONE; N];
        for (column, name) in columns.iter_mut().zip(names) {
            *column = self.find(name)?.ok_or_else(|| self.lacks(name))?;
        }
        Ok(columns)
    }

    /// Finds the columns `names`, or `None` if any is missing.
    ///
    /// # Errors
    /// Those of [`Self::find`].
    pub fn all<const N: usize>(&self, names: [&str; N]) -> Result<Option<[Column; N]>, Error> {
        let mut columns = [Column::NONE; N];
        for (column, name) in columns.iter_mut().zip(names) {
            let Some(found) = self.find(name)? else { return Ok(None) };
            *column = found;
        }
        Ok(Some(columns))
    }

    /// The column of this name, apart from a unit in brackets after it.
    pub fn with_unit(&self, name: &str) -> Option<&str> {
        let bare = |column: &str| column.split(['[', '(']).next().map(str::trim) == Some(name);
        self.heading.names().iter().map(String::as_str).find(|column| bare(column))
    }

    /// A sentence that lists the unused columns, if there are any.
    fn left_out(&self) -> Option<String> {
        let found = self.found.borrow();
        let is_found = |at: usize| found.iter().any(|(_, column, _)| column.at == at);
        let names = self.heading.names().iter().enumerate();
        let names = names.filter(|(at, name)| !is_found(*at) && !name.trim().is_empty());
        let names = listed(names.map(|(_, name)| name.as_str()), MOST_NAMED);
        (!names.is_empty()).then(|| format!("columns that are not used: {names}"))
    }
}

/// A line of a file.
#[derive(Debug, Clone, Copy)]
pub struct Line<'a> {
    path: &'a Path,
    number: usize,
}

impl Line<'_> {
    /// An error about this line.
    pub fn error(&self, problem: impl Into<String>) -> Error {
        let path = self.path.to_path_buf();
        Error::Line { path, line: self.number, problem: problem.into() }
    }
}

/// A line below the header.
#[derive(Debug)]
pub struct Row<'a> {
    /// The line, for error messages.
    pub line: Line<'a>,
    table: &'a NamedTable<'a>,
    fields: Vec<Cow<'a, [u8]>>,
    /// The unit of time in seconds, if no header states it.
    second: f64,
}

impl Row<'_> {
    /// The text of a field.
    pub fn text(&self, column: Column) -> Cow<'_, str> {
        String::from_utf8_lossy(self.field(column))
    }

    /// Whether a field is empty, or holds the `nan` that programs write in its place.
    pub fn is_empty(&self, column: Column) -> bool {
        let field = self.field(column);
        field.is_empty() || field.eq_ignore_ascii_case(b"nan")
    }

    fn field(&self, column: Column) -> &[u8] {
        self.fields.get(column.at).map_or(&[], |field| field)
    }

    /// A number in SI units, which may be infinite or NaN; `None` if the field holds anything else.
    pub fn any_number(&self, column: Column) -> Option<f64> {
        let value = self.table.number(self.field(column))?;
        // A value in the usual unit is kept bit for bit.
        Some(if column.scale == 1.0 { value } else { value * column.scale })
    }

    /// A finite number in SI units.
    ///
    /// # Errors
    /// [`Error::Line`] if the field holds anything else.
    pub fn number(&self, name: &str, column: Column) -> Result<f64, Error> {
        self.any_number(column).filter(|value| value.is_finite()).ok_or_else(|| {
            let found = printable(&self.text(column));
            self.line.error(format!("expected a finite number in column {name}, found {found}"))
        })
    }

    /// A coordinate in metres.
    ///
    /// # Errors
    /// [`Error::Line`] if the field is not a number, or lies beyond the earth.
    pub fn coordinate(&self, name: &str, column: Column) -> Result<f64, Error> {
        let value = self.number(name, column)?;
        if value.abs() > FARTHEST_POSITION {
            return Err(self
                .line
                .error("expected a position in metres, found one beyond the earth"));
        }
        Ok(value)
    }

    /// A time in microseconds, from a number, a date with a time, or a time of day. A clock that begins anew, at midnight or at the end
    /// of 32 bits, is continued: to be called for one line after the other.
    ///
    /// # Errors
    /// [`Error::Line`] if the field is not a time, or lies beyond any clock.
    pub fn time_us(&self, column: Column) -> Result<i64, Error> {
        let counted = || Some(self.table.count(self.field(column))? * (column.scale * self.second));
        let Some(seconds) = self.table.moment(self.field(column)).or_else(counted) else {
            let found = printable(&self.text(column));
            return Err(self.line.error(format!("expected a time in column t, found {found}")));
        };
        if seconds.abs() > LATEST_TIME {
            return Err(self.line.error("expected a time in seconds, found one beyond any clock"));
        }
        Ok((seconds * 1e6).round() as i64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(text: &[u8], options: &Options) -> Result<(f64, Found), String> {
        let mut sum = 0.0;
        let found = parse(
            Path::new("a.csv"),
            text,
            &Log { what: "numbers", usual_step_s: Some([2e-3, 2.0]), options },
            |header| header.require(["t", "range"]),
            |&[t, range], row| {
                sum += row.time_us(t)? as f64 + row.number("range", range)?;
                Ok(())
            },
        );
        found.map(|found| (sum, found)).map_err(|error| error.to_string())
    }

    #[test]
    fn tables_are_read_however_they_are_written() {
        let options = Options::default();
        for text in [
            "t,range\n1,2\n2,3\n",
            "# made by hand\n\nt;range\n1;2\n2;3\n",
            "range [cm]\ttime_ms\r\n200\t1000\r\n300\t2000\r\n",
            "t;distance\n1,0;2,0\n2,0;3,0\n",
            "time,d (mm)\n00:00:01,2000\n00:00:02,3000\n",
            "t,range\n1000,2\n2000,3\n",
        ] {
            let (sum, found) = sum(text.as_bytes(), &options).unwrap();
            assert!((sum - 3_000_005.0).abs() < 1e-6, "{text}: {sum}");
            assert_eq!(found.warnings, [""; 0]);
        }
        let (_, found) = sum(b"range [cm];t\n1;1\n", &options).unwrap();
        assert_eq!(found.import, ["range = range [cm] in cm, semicolons: header"]);
    }

    #[test]
    fn damaged_lines_of_a_log_are_skipped_and_told() {
        let text = b"t,range\n1,2\n2,x\n2,3\n3";
        let (sum_found, found) = sum(text, &Options::default()).unwrap();
        assert!((sum_found - 3_000_005.0).abs() < 1e-6);
        assert_eq!(
            found.warnings,
            [
                "2 lines unusable were skipped: lines 3, 5",
                "the log does not end with a line break: its end may be cut"
            ]
        );
        let strict = Options { strict: true, ..Options::default() };
        assert_eq!(
            sum(text, &strict).unwrap_err(),
            "a.csv, line 3: expected a finite number in column range, found \"x\""
        );
        for (text, expected) in [
            (&b"t\n1\n"[..], "a.csv, line 1: expected a header with a column range, found t"),
            (b"", "a.csv: expected numbers, found an empty file"),
            (b"t,range\n", "a.csv: expected numbers, found only a header"),
            (
                b"t,range\n1,x\n",
                "a.csv, line 2: expected a finite number in column range, found \"x\"",
            ),
        ] {
            assert_eq!(sum(text, &Options::default()).unwrap_err(), expected);
        }
    }
}
